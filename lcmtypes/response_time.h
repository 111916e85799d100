#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

namespace nextview {

/// How long it takes until what is waited for comes, and with that how long to wait before asking
/// for it again: TCP's estimate from a smoothed time and its variation (RFC 6298, section 2).
/// Only times of what was not asked for twice count, for of others nobody knows which of the
/// askings was answered (Karn's algorithm).
class ResponseTime {
 public:
  using Seconds = std::chrono::duration<double>;
  using milliseconds = std::chrono::milliseconds;

  static constexpr milliseconds kFirstTimeout{100};  ///< until anything is known
  static constexpr milliseconds kShortestTimeout{
      5};  ///< what a busy machine takes to wake somebody
  static constexpr milliseconds kLongestTimeout{800};

  /// Something has come after so long.
  void took(Seconds time) {
    if (!smoothed_) {
      smoothed_ = time;
      variation_ = time / 2;
      return;
    }
    const Seconds error = time - *smoothed_;
    variation_ += (Seconds(std::abs(error.count())) - variation_) / 4;
    *smoothed_ += error / 8;
  }
  /// How long to wait before asking again.
  milliseconds timeout() const {
    if (!smoothed_) return kFirstTimeout;
    return std::clamp(std::chrono::ceil<milliseconds>(*smoothed_ + 4 * variation_),
                      kShortestTimeout, kLongestTimeout);
  }

 private:
  std::optional<Seconds> smoothed_;
  Seconds variation_{0.0};
};

}  // namespace nextview
