#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

namespace nextview {

/// A voxel's signed indices (i, j, k) along the world's x, y, z (P3).
using VoxelIndex = Eigen::Vector3i;

/// The lattice of voxels laid over the world: cubes aligned with its axes.
struct VoxelGrid {
  double voxel_size_m = 0.10;                          ///< "scale" in the paper
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();  ///< world position of voxel (0,0,0)'s centre

  /// Eq. 2: nearest voxel centre per axis, trunc((x + sgn(x) scale/2) / scale) relative to the
  /// origin; ties go away from zero. The point must be finite and within +-1e9 voxels.
  VoxelIndex voxel_of(const Eigen::Vector3d& point_m) const {
    VoxelIndex index;
    for (int axis = 0; axis < 3; ++axis) {
      const double x = point_m[axis] - origin_m[axis];
      const double half = std::copysign(0.5 * voxel_size_m, x);
      index[axis] = static_cast<int>((x + half) / voxel_size_m);
    }
    return index;
  }

  /// World position of a voxel's centre, metres.
  Eigen::Vector3d center_m(const VoxelIndex& index) const {
    return origin_m + voxel_size_m * index.cast<double>();
  }
};

/// The box of voxels a map covers: min <= index < min + size on every axis.
struct MapWindow {
  VoxelIndex min = VoxelIndex::Zero();
  VoxelIndex size = VoxelIndex(64, 48, 32);

  bool contains(const VoxelIndex& index) const {
    for (int axis = 0; axis < 3; ++axis) {
      // One unsigned comparison covers both ends.
      if (static_cast<std::uint32_t>(index[axis] - min[axis]) >=
          static_cast<std::uint32_t>(size[axis])) {
        return false;
      }
    }
    return true;
  }
  bool operator==(const MapWindow& other) const = default;
};

}  // namespace nextview
