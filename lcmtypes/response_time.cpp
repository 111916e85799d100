#include "lcmtypes/response_time.h"

#include <algorithm>

namespace nextview {

void ResponseTime::took(Seconds time) { times_[took_++ % kTimes] = time; }

ResponseTime::milliseconds ResponseTime::timeout() const {
  constexpr double kTimesTheUsual = 4.0;
  if (took_ == 0) return kFirstTimeout;
  std::array<Seconds, kTimes> times = times_;
  const std::size_t known = std::min(took_, kTimes);
  const auto quartile = times.begin() + static_cast<std::ptrdiff_t>((known - 1) / 4);
  std::nth_element(times.begin(), quartile, times.begin() + static_cast<std::ptrdiff_t>(known));
  return std::clamp(std::chrono::ceil<milliseconds>(kTimesTheUsual * *quartile), kShortestTimeout,
                    kLongestTimeout);
}

}  // namespace nextview
