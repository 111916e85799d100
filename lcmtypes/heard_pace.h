#pragma once

#include <chrono>
#include <cstdint>

#include "lcmtypes/channels.h"

namespace nextview {

/// How far the run may go, as last heard (pace_t).
class HeardPace {
 public:
  using Clock = std::chrono::steady_clock;

  void hear(const pace_t& pace, Clock::time_point now) {
    if (pace.pace_number < number_) return;  // overtaken on the bus
    number_ = pace.pace_number;
    last_view_ = pace.last_view;
    until_ = now + std::chrono::duration_cast<Clock::duration>(
                       std::chrono::duration<double>(pace.holds_s));
  }
  /// Whether the goal of a view has to wait.
  bool holds(int view, Clock::time_point now) const { return view > last_view_ && now < until_; }

 private:
  std::int64_t number_ = -1;
  std::int32_t last_view_ = 0;
  Clock::time_point until_;  ///< long ago, until something is heard
};

}  // namespace nextview
