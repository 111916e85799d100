#include "sensor_sim/measured_range.h"

#include <algorithm>
#include <cstdint>

#include "sensor/vector_clones.h"

namespace nextview {
namespace {

// Up to here a range in steps of 0.1 mm fits 32 bits, which vectors convert at once.
constexpr double kLongestInSteps_m = 2e5;

// Multiplied by 1e-4 and not divided by 1e4, which takes longer than all the rest. In double the
// two differ by 2^-52 of the range at most. No whole number of steps below 1e10 lies nearer than
// 2^-39 of itself to the middle between two floats, so as floats they are the same. What outweighs
// a range is added to it, because to choose between them compilers put a branch around the
// arithmetic.
NEXTVIEW_VECTOR_CLONES
void measure_in_steps(std::size_t count, double min_m, double max_m, float* __restrict range_m) {
  constexpr float kInvalid = std::numeric_limits<float>::quiet_NaN();
  constexpr float kNoReturn = std::numeric_limits<float>::infinity();
#pragma omp simd
  for (std::size_t i = 0; i < count; ++i) {
    const auto distance_m = static_cast<double>(range_m[i]);
    const double within_m = distance_m < max_m ? distance_m : max_m;
    const auto steps = static_cast<std::int32_t>(within_m * 1e4 + 0.5);
    const auto quantised_m = static_cast<float>(static_cast<double>(steps) * 1e-4);
    const float no_return = distance_m > max_m ? kNoReturn : 0.0F;
    range_m[i] = quantised_m + (distance_m >= min_m ? no_return : kInvalid);
  }
}

}  // namespace

void measure_ranges(const RangeLimits& limits, std::span<float> distance_m) {
  if (limits.max_m <= kLongestInSteps_m) {
    measure_in_steps(distance_m.size(), limits.min_m, limits.max_m, distance_m.data());
    return;
  }
  for (float& range_m : distance_m) {
    range_m = measured_range(static_cast<double>(range_m), limits);
  }
}

}  // namespace nextview
