#pragma once

#include <algorithm>
#include <chrono>

namespace nextview {

/// Lets simulated time pass by the clock on the wall, for people who watch: what a simulator says
/// of a motion or a scan it says when that is over. What it says is the same at every pace.
class RealTime {
 public:
  using Clock = std::chrono::steady_clock;
  using milliseconds = std::chrono::milliseconds;

  /// @param factor simulated seconds a second; 0: at once
  explicit RealTime(double factor = 0.0) : factor_(factor) {}

  /// Something begins that takes so long.
  void begin(double simulated_s) {
    over_ = Clock::now();
    if (factor_ <= 0.0) return;
    over_ += std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(simulated_s / factor_));
  }
  bool is_over() const { return Clock::now() >= over_; }
  /// Until it is over.
  milliseconds left() const {
    return std::max(std::chrono::ceil<milliseconds>(over_ - Clock::now()), milliseconds(0));
  }

 private:
  double factor_;
  Clock::time_point over_;
};

}  // namespace nextview
