#pragma once

#include <limits>
#include <span>

#include "sensor/range_image.h"

namespace nextview {

/// What a sensor says of a surface at a distance, in metres: NaN (invalid) below limits.min_m, +inf
/// (no return) above limits.max_m, else the distance rounded by quantise_range.
inline float measured_range(double distance_m, const RangeLimits& limits) {
  if (distance_m < limits.min_m) return std::numeric_limits<float>::quiet_NaN();
  if (distance_m > limits.max_m) return std::numeric_limits<float>::infinity();
  return quantise_range(distance_m);
}

/// measured_range of many distances of 0 or more, each replaced by its range.
void measure_ranges(const RangeLimits& limits, std::span<float> distance_m);

}  // namespace nextview
