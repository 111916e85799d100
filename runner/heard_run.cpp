#include "runner/heard_run.h"

#include <algorithm>

namespace nextview {

void HeardRun::listen(Bus& bus) {
  const auto add = [this](const auto& message) { take(message); };
  bus.on<goal_t>(add);
  bus.on<search_t>(add);
  bus.on<arrival_t>(add);
  bus.on<range_image_t>(add);
  bus.on<commit_t>(add);
  bus.on<stop_t>(add);
  bus.on<timing_t>([this](const timing_t& timing) {
    record.add(timing);
    // One that has been started again gets on without saying anything new.
    int& view = worked_on[timing.role];
    if (timing.view > view) last_progress = Clock::now();
    view = std::max(view, timing.view);
  });
  bus.on<pace_t>([this](const pace_t& message) { pace.hear(message, Clock::now()); });
  bus.on<status_t>([this](const status_t& status) {
    statuses[status.role] = status;
    fresh_statuses.insert(status.role);
  });
  bus.on_missing([this](const request_t& request) {
    if (request.wanted_channel == Channel<run_config_t>::name) {
      asked_for_config.insert(request.asker);
    }
    if (on_missing) on_missing(request);
  });
}

bool HeardRun::paused() const {
  const int view = record.latest_view();
  const bool done = view == 0 || record.commit(view) != nullptr;
  return done && pace.holds(view + 1, Clock::now());
}

}  // namespace nextview
