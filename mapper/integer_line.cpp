#include "mapper/integer_line.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>

namespace nextview {

namespace {

// round(displacement * 2^16 / steps), ties away from zero, in integers.
std::int32_t fixed_point_slope(std::int64_t displacement, std::int64_t steps) {
  const std::int64_t scaled = std::abs(displacement) << IntegerLine::kFractionBits;
  const std::int64_t rounded = (2 * scaled + steps) / (2 * steps);
  return static_cast<std::int32_t>(displacement < 0 ? -rounded : rounded);
}

// The largest k >= 0 with lo <= (k * slope + 2^15) >> 16 <= hi, given that k = 0 satisfies it.
std::int64_t last_step_between(std::int64_t slope, std::int64_t lo, std::int64_t hi) {
  if (slope > 0) {
    // k * slope + half < (hi + 1) << 16
    return (((hi + 1) << IntegerLine::kFractionBits) - IntegerLine::kHalf - 1) / slope;
  }
  if (slope < 0) {
    // k * slope + half >= lo << 16
    return (IntegerLine::kHalf - (lo * (std::int64_t{1} << IntegerLine::kFractionBits))) / -slope;
  }
  return std::numeric_limits<std::int64_t>::max();
}

}  // namespace

IntegerLine line_between(const VoxelIndex& start, const VoxelIndex& end) {
  IntegerLine line;
  line.start = start;
  const VoxelIndex displacement = end - start;
  for (int axis = 1; axis < 3; ++axis) {
    if (std::abs(displacement[axis]) > std::abs(displacement[line.driving_axis])) {
      line.driving_axis = axis;
    }
  }
  line.steps = std::abs(displacement[line.driving_axis]);
  if (line.steps > IntegerLine::kMaxSteps) {
    throw std::invalid_argument("a voxel line of more than 32767 steps");
  }
  line.direction = displacement[line.driving_axis] < 0 ? -1 : 1;
  if (line.steps > 0) {
    for (int axis = 0; axis < 3; ++axis) {
      line.slope[axis] = fixed_point_slope(displacement[axis], line.steps);
    }
  }
  return line;
}

IntegerLine line_along(const VoxelIndex& start, const Eigen::Vector3d& direction,
                       double reach_voxels) {
  if (!(reach_voxels >= 1.0 && reach_voxels <= IntegerLine::kMaxSteps)) {
    throw std::invalid_argument("a voxel line's reach must lie between 1 and 32767 voxels");
  }
  VoxelIndex displacement;
  for (int axis = 0; axis < 3; ++axis) {
    displacement[axis] = static_cast<int>(std::lround(direction[axis] * reach_voxels));
  }
  return line_between(start, start + displacement);
}

int steps_inside(const IntegerLine& line, const MapWindow& window) {
  if (line.steps == 0) return 0;
  std::int64_t last = std::numeric_limits<std::int64_t>::max();
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t lo = std::int64_t{window.min[axis]} - line.start[axis];
    const std::int64_t hi = lo + window.size[axis] - 1;
    last = std::min(last, last_step_between(line.slope[axis], lo, hi));
  }
  return static_cast<int>(last);
}

}  // namespace nextview
