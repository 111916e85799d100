#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

#include "bench/ray_meeting.h"
#include "mapper/voxel_map.h"

namespace nextview {

/// What OpenVDB says a ray meets: its DDA over a pruned grid of one-byte labels, read through a
/// ValueAccessor. One object serves one thread.
class OpenvdbCaster {
 public:
  OpenvdbCaster(const VoxelMap& map, double reach_voxels);
  ~OpenvdbCaster();
  Meeting cast(const VoxelIndex& sensor, const Eigen::Vector3d& direction) const;

 private:
  struct Grid;
  std::unique_ptr<Grid> grid_;
  double reach_;
};

/// The map update over an OpenVDB label grid: for every point its DDA from the sensor, Empty up to
/// the point, Occupied at it and, if asked for, Occluded behind it up to the window's limit.
/// Neither occlusion planes, normals nor quality.
class OpenvdbMap {
 public:
  OpenvdbMap(const VoxelGrid& grid, const MapWindow& window);
  ~OpenvdbMap();
  void insert(const Eigen::Vector3d& sensor_m, std::span<const Eigen::Vector3d> points_m,
              bool mark_occluded);
  Label label(const VoxelIndex& voxel) const;
  std::size_t memory_bytes() const;

 private:
  struct Grid;
  VoxelGrid voxels_;
  MapWindow window_;
  std::unique_ptr<Grid> grid_;
};

/// The version of the library in use.
const char* openvdb_version();

}  // namespace nextview
