#pragma once

#include <stop_token>
#include <vector>

#include "mapper/voxel_grid.h"
#include "scene/scene.h"
#include "scoring/cover_sets.h"
#include "scoring/visible_surface.h"
#include "sensor/sensor_geometry.h"
#include "sensor/sensor_pose.h"

namespace nextview {

/// The poses that are looked at, and with which sensor.
struct PoseParameters {
  SensorGeometry sensor = TiltedLineScan::paper();
  RangeLimits limits;
  VoxelGrid grid;           ///< of the map that is to be filled
  double spacing_m = 0.40;  ///< of positions
  int subdivisions = 2;     ///< of the icosahedron whose faces are the orientations: 320
  std::size_t most_bytes = 8'000'000'000;  ///< of what they cover, which stays in memory

  /// @throws std::invalid_argument naming the parameter that cannot be
  void check() const;
};

/// What a sensor would recover from each of many poses.
struct PoseCover {
  std::vector<SensorPose> poses;  ///< the start first
  CoverSets sets;                 ///< by pose; of the voxels that hold visible samples
  std::vector<double> nearest_m;  ///< by voxel: straight from the start to a pose that covers it
};

/// Scans a scene, without noise, from the start and from positions at a spacing, in all
/// orientations. A pose covers the voxels that its points fall in, as in a run.
/// @param reachable positions of a lattice; taken are those nearest to multiples of the spacing
/// @throws std::invalid_argument for parameters that cannot be, and when the result would be
///         too large
PoseCover cover_of_poses(const Scene& scene, const SensorPose& start,
                         const std::vector<Eigen::Vector3d>& reachable,
                         const VisibleSurface& surface, const PoseParameters& parameters,
                         const std::stop_token& stop = {}, WorkProgress* progress = nullptr);

}  // namespace nextview
