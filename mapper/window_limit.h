#pragma once

#include <Eigen/Core>

#include "mapper/voxel_grid.h"

namespace nextview {

/// The box of the world that a window's voxels fill, along one axis.
struct WindowExtent {
  double low_m;
  double high_m;
};
WindowExtent window_extent(const VoxelGrid& grid, const MapWindow& window, int axis);

/// The limit of a ray (P12): the voxel of the window where the ray leaves it.
///
/// The ray leaves through the face it comes to first. Across that face the voxel is the window's
/// outermost; along it, the voxel of the point where the ray meets the face (eq. 2), held inside
/// the window where that point rounds to just outside. Of two faces met at once the lower axis
/// counts. Products are compared in place of quotients, so that one division is left; every
/// operation is one that IEEE rounds one way.
///
/// @param position_m  inside the window
/// @param direction   of the world frame, not zero
VoxelIndex limit_of_ray(const VoxelGrid& grid, const MapWindow& window,
                        const Eigen::Vector3d& position_m, const Eigen::Vector3d& direction);

}  // namespace nextview
