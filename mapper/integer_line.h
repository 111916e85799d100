#pragma once

#include <cstdint>

#include "mapper/voxel_grid.h"

namespace nextview {

/// A straight voxel line in fixed-point closed form: the paper's 3-D Bresenham (P11).
///
/// Along the driving axis, the one with the largest displacement, the line advances one voxel a
/// step. After k steps the other two axes have advanced by (k * slope + 2^15) >> 16, with
/// slope = round(displacement * 2^16 / steps) and an arithmetic shift. k is the only state, so a
/// line can be entered anywhere and carried on beyond its end.
///
///     k:        0   1   2   3   4   5         driving axis ->
///             +---+---+---+---+---+---+
///             | o | o |   |   |   |   |       start = at(0)
///             +---+---+---+---+---+---+
///             |   |   | o | o | o |   |
///             +---+---+---+---+---+---+
///             |   |   |   |   |   | o |       end = at(steps)
///             +---+---+---+---+---+---+
struct IntegerLine {
  static constexpr int kFractionBits = 16;
  static constexpr std::int64_t kHalf = std::int64_t{1} << (kFractionBits - 1);
  /// Lines are exact up to this many steps.
  static constexpr int kMaxSteps = 32767;

  VoxelIndex start = VoxelIndex::Zero();
  int driving_axis = 0;  ///< ties go to the lower axis
  int direction = 1;     ///< +1 or -1 along the driving axis
  int steps = 0;         ///< driving-axis distance from start to end; 0 when they coincide
  std::int32_t slope[3] = {0, 0, 0};  ///< per axis; the driving axis holds direction << 16

  /// The voxel after k >= 0 steps; k = steps is the end, larger k lie beyond it.
  VoxelIndex at(int k) const {
    VoxelIndex index;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t advance = std::int64_t{k} * slope[axis] + kHalf;
      index[axis] = start[axis] + static_cast<int>(advance >> kFractionBits);
    }
    return index;
  }
};

/// The line from one voxel to another.
/// @throws std::invalid_argument when they are more than IntegerLine::kMaxSteps apart on an axis
IntegerLine line_between(const VoxelIndex& start, const VoxelIndex& end);

/// The line from a voxel along a direction: the line to start + reach_voxels * direction, rounded
/// to the nearest voxel (ties away from zero). The displacement does not depend on the start, so
/// the slopes of a ray can be tabulated once for all positions.
/// @param direction unit vector of the world frame
/// @throws std::invalid_argument when reach_voxels is not in [1, IntegerLine::kMaxSteps]
IntegerLine line_along(const VoxelIndex& start, const Eigen::Vector3d& direction,
                       double reach_voxels);

/// The number of steps a line that starts inside a window can take without leaving it. Exact: at(k)
/// is inside for every k up to and including the result, and outside right after.
/// A line of zero steps never leaves; the result is then 0.
int steps_inside(const IntegerLine& line, const MapWindow& window);

}  // namespace nextview
