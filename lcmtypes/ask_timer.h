#pragma once

#include <algorithm>
#include <chrono>

namespace nextview {

/// When to ask again for what does not come: at an even pace for a while, for most often the one
/// thing that was lost comes with the next answer or the one after it; then ever less often, for
/// then somebody works, or is gone. (TCP does the same for thin streams: tcp_thin_linear_timeouts.)
class AskTimer {
 public:
  using Clock = std::chrono::steady_clock;
  using milliseconds = std::chrono::milliseconds;

  /// How often it is due before its waits grow.
  static constexpr int kEvenAsks = 8;

  /// @param first wait before it is due; after kEvenAsks of them each is twice the one before ...
  /// @param longest ... up to this one
  explicit AskTimer(milliseconds first, milliseconds longest)
      : first_(first), longest_(longest), wait_(first), due_(Clock::now() + first) {}

  /// Begins anew: something has come.
  void restart() {
    wait_ = first_;
    asked_ = 0;
    due_ = Clock::now() + wait_;
  }
  /// Likewise, with another first wait.
  void restart(milliseconds first) {
    first_ = std::min(first, longest_);
    restart();
  }
  /// Whether to ask now; then it is due again after the next wait.
  bool due() {
    const auto now = Clock::now();
    if (now < due_) return false;
    if (++asked_ >= kEvenAsks) wait_ = std::min(2 * wait_, longest_);
    due_ = now + wait_;
    return true;
  }
  /// How long it will not be due.
  milliseconds left() const {
    return std::max(std::chrono::ceil<milliseconds>(due_ - Clock::now()), milliseconds(0));
  }

 private:
  milliseconds first_;
  milliseconds longest_;
  milliseconds wait_;
  int asked_ = 0;
  Clock::time_point due_;
};

}  // namespace nextview
