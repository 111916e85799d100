#include "mapper/window_limit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nextview {

WindowExtent window_extent(const VoxelGrid& grid, const MapWindow& window, int axis) {
  const auto face_m = [&](int index) {
    return grid.origin_m[axis] + grid.voxel_size_m * (static_cast<double>(index) - 0.5);
  };
  return {face_m(window.min[axis]), face_m(window.min[axis] + window.size[axis])};
}

VoxelIndex limit_of_ray(const VoxelGrid& grid, const MapWindow& window,
                        const Eigen::Vector3d& position_m, const Eigen::Vector3d& direction) {
  // The ray covers `way_m` along an axis before it leaves, at `speed` for each metre of its length.
  double way_m = std::numeric_limits<double>::infinity();
  double speed = 1.0;
  int axis_left = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const WindowExtent extent = window_extent(grid, window, axis);
    const double face_m = direction[axis] < 0.0 ? extent.low_m : extent.high_m;
    const double axis_way_m = std::abs(face_m - position_m[axis]);
    const double axis_speed = std::abs(direction[axis]);
    if (axis_way_m * speed < way_m * axis_speed) {
      way_m = axis_way_m;
      speed = axis_speed;
      axis_left = axis;
    }
  }
  const double length_m = way_m / speed;

  const VoxelIndex last = window.min + window.size - VoxelIndex::Ones();
  VoxelIndex limit = grid.voxel_of(position_m + length_m * direction);
  limit = limit.cwiseMax(window.min).cwiseMin(last);
  limit[axis_left] = direction[axis_left] < 0.0 ? window.min[axis_left] : last[axis_left];
  return limit;
}

}  // namespace nextview
