#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
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

/// Voxels are stored, counted and hashed in blocks of 8 x 8 x 8 that are aligned to absolute
/// indices, so that a block is the same wherever the window lies.
constexpr int kBlockBits = 3;
constexpr int kBlockSide = 1 << kBlockBits;
constexpr int kBlockVoxels = kBlockSide * kBlockSide * kBlockSide;

/// The coordinate of the block an index lies in, rounded down also below zero.
constexpr int block_of_index(int index) { return index >> kBlockBits; }

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
  bool is_empty() const { return (size.array() <= 0).any(); }
  bool operator==(const MapWindow& other) const = default;
};

/// What a window leaves when it moves to start at new_min: boxes of which none meets another. Those
/// that are not needed are empty.
inline std::array<MapWindow, 3> left_behind(const MapWindow& window, const VoxelIndex& new_min) {
  std::array<MapWindow, 3> boxes;
  // Peeled off one axis after the other, each at one end; [min, end) is what remains.
  VoxelIndex min = window.min;
  VoxelIndex end = window.min + window.size;
  for (int axis = 0; axis < 3; ++axis) {
    VoxelIndex box_min = min;
    VoxelIndex box_end = end;
    if (new_min[axis] > window.min[axis]) {
      min[axis] = box_end[axis] = std::min(new_min[axis], end[axis]);
    } else {
      end[axis] = box_min[axis] = std::max(new_min[axis] + window.size[axis], min[axis]);
    }
    boxes[static_cast<std::size_t>(axis)] = {box_min, box_end - box_min};
  }
  return boxes;
}

/// What two boxes share; empty when they do not meet.
inline MapWindow overlap(const MapWindow& a, const MapWindow& b) {
  const VoxelIndex min = a.min.cwiseMax(b.min);
  const VoxelIndex end = (a.min + a.size).cwiseMin(b.min + b.size);
  return {min, (end - min).cwiseMax(0)};
}

/// Calls see(voxel) for the first voxel of every row along x of a box, y fastest; not when it is
/// empty.
template <typename See>
void for_each_row(const MapWindow& box, See see) {
  if (box.is_empty()) return;
  const VoxelIndex end = box.min + box.size;
  for (int k = box.min[2]; k < end[2]; ++k) {
    for (int j = box.min[1]; j < end[1]; ++j) see(VoxelIndex(box.min[0], j, k));
  }
}

/// Calls see(voxel) for every voxel of a box, x fastest.
template <typename See>
void for_each_voxel(const MapWindow& box, See see) {
  for_each_row(box, [&](const VoxelIndex& first) {
    for (int n = 0; n < box.size[0]; ++n) see(VoxelIndex(first[0] + n, first[1], first[2]));
  });
}

}  // namespace nextview
