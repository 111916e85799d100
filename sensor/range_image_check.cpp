#include "sensor/range_image_check.h"

#include <Eigen/LU>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "sensor/vector_clones.h"

namespace nextview {

bool on_unit_circle(std::span<const double> sines, std::span<const double> cosines) {
  for (std::size_t i = 0; i < sines.size(); ++i) {
    const double square = sines[i] * sines[i] + cosines[i] * cosines[i];
    if (!(std::abs(square - 1.0) <= kUnitTolerance)) return false;
  }
  return true;
}

bool is_rotation(const Eigen::Matrix3d& matrix) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double product = matrix.col(i).dot(matrix.col(j));
      if (!(std::abs(product - (i == j ? 1.0 : 0.0)) <= kUnitTolerance)) return false;
    }
  }
  return matrix.determinant() > 0.0;
}

bool are_range_limits(const RangeLimits& limits) {
  return limits.min_m >= 0.0 && limits.min_m < limits.max_m && std::isfinite(limits.max_m);
}

// Goes on to the end, wrong or not, because only then compilers make vectors of it.
NEXTVIEW_VECTOR_CLONES
bool are_ranges(std::span<const float> range_m) {
  std::int32_t negative = 0;
#pragma omp simd reduction(| : negative)
  for (std::size_t n = 0; n < range_m.size(); ++n) {
    negative |= static_cast<std::int32_t>(range_m[n] < 0.0f);
  }
  return negative == 0;
}

}  // namespace nextview
