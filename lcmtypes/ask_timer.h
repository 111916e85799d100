#pragma once

#include <algorithm>
#include <chrono>

namespace nextview {

/// When to ask again for what does not come: soon, then ever less often.
class AskTimer {
 public:
  using Clock = std::chrono::steady_clock;
  using milliseconds = std::chrono::milliseconds;

  /// @param first wait before it is due for the first time; each wait is twice the one before ...
  /// @param longest ... up to this one
  explicit AskTimer(milliseconds first, milliseconds longest)
      : first_(first), longest_(longest), wait_(first), due_(Clock::now() + first) {}

  /// Begins anew: something has come.
  void restart() {
    wait_ = first_;
    due_ = Clock::now() + wait_;
  }
  /// Whether to ask now; then it is due again after the next wait.
  bool due() {
    const auto now = Clock::now();
    if (now < due_) return false;
    wait_ = std::min(2 * wait_, longest_);
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
  Clock::time_point due_;
};

}  // namespace nextview
