#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace nextview {

/// The median of what a table of a run or of a benchmark sums up in one figure: of an even number
/// of values half way between the middle two. 0 of no values.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

}  // namespace nextview
