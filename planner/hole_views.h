#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "planner/field_of_view.h"
#include "planner/prediction/free_space_field.h"
#include "planner/shortest_paths.h"
#include "planner/surface_holes.h"
#include "sensor/sensor_pose.h"

namespace nextview {

/// What a view into a hole must be like.
struct HoleViewParameters {
  FieldOfView field;
  double range_min_m = 0.05;
  double range_max_m = 30.0;
  double min_cosine = 0.2;        ///< between the line of sight and the way out of the hole
  double path_cost_per_m = 0.12;  ///< lambda

  /// @throws std::invalid_argument naming the parameter that cannot be
  void check() const;
};

/// A view into a hole.
struct HoleView {
  std::size_t hole = 0;  ///< it was computed for
  VoxelIndex voxel = VoxelIndex::Zero();
  double pan_rad = 0.0;
  double tilt_rad = 0.0;
  double path_m = 0.0;
  /// Voxels of all holes that it is expected to show: each by its trust, and by the share of its
  /// kind that the sensor's rays hit from there.
  double gain_voxels = 0.0;
  double score = 0.0;                      ///< gain exp(-lambda path)
  std::vector<const HoleVoxel*> in_sight;  ///< of all holes, in their order
};

/// Of the views into all holes so many, those that show most of their own hole for the way there,
/// are asked what they show of the others. In a large building's first views there are ten times as
/// many, and to ask them all took seconds.
constexpr std::size_t kMostHoleViews = 128;

/// Whether nothing but known free space lies between two voxels, on the line of a ray from one to
/// the other. Both inside the field's window.
bool is_in_sight(const FreeSpaceField& field, const VoxelIndex& from, const VoxelIndex& to);

/// Computes for every hole the view into it (P24): from the positions that are offered the one, and
/// aimed at the middle of what is to be seen of the hole from there, that shows most of it for the
/// way there. A voxel of a hole is to be seen when it lies within the sensor's range, it is not met
/// at too flat an angle, and it is in sight through the map. What such a view shows of other holes
/// counts too.
/// @param field of the map the holes are of
/// @param voxel_m the side of its voxels
/// @param positions with paths, as ShortestPaths::reached() has them; with the nearest first it
///        takes the least time
/// @return the best first, at most kMostHoleViews; holes that cannot be looked into from any of the
///         positions are left out
/// @throws std::invalid_argument for parameters that cannot be
std::vector<HoleView> hole_views(const FreeSpaceField& field, double voxel_m,
                                 std::span<const SurfaceHole> holes, const ShortestPaths& paths,
                                 std::span<const VoxelIndex> positions,
                                 const HoleViewParameters& parameters);

}  // namespace nextview
