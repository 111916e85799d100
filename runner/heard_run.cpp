#include "runner/heard_run.h"

#include <algorithm>
#include <string>

#include "runner/heard_checks.h"

namespace nextview {
namespace {

/// Drivers, viewers and planners have names of their own, but there are not that many of them.
void check_room_for(const std::string& role, std::size_t known) {
  constexpr std::size_t kMostRoles = 32;
  constexpr std::size_t kLongestRole = 64;
  if (role.size() > kLongestRole) throw RejectedMessage("a role's name that is too long");
  if (known >= kMostRoles) {
    throw RejectedMessage("an unknown role, beyond the " + std::to_string(kMostRoles) +
                          " there may be");
  }
}

}  // namespace

void HeardRun::listen(Bus& bus) {
  const auto add = [this](const auto& message) {
    note_view(message);
    check_follows(message, record);
    take(message);
  };
  bus.on<goal_t>([this, add, &bus](const goal_t& goal) {
    add(goal);
    if (!ending && record.stop() && goal.view > record.stop()->views) {
      record.forget_stop();
      bus.take_back<stop_t>({}, "nobody decided it: the planner goes on");
    }
  });
  bus.on<search_t>(add);
  bus.on<arrival_t>(add);
  bus.on<range_image_t>(add);
  bus.on<commit_t>(add);
  bus.on<stop_t>([this, add](const stop_t& stop) {
    if (!ending) add(stop);
  });
  bus.on<timing_t>([this](const timing_t& timing) {
    check_follows(timing, record);
    if (!worked_on.contains(timing.role)) check_room_for(timing.role, worked_on.size());
    record.add(timing);
    // One that has been started again gets on without saying anything new.
    int& view = worked_on[timing.role];
    if (timing.view > view) last_progress = Clock::now();
    view = std::max(view, timing.view);
  });
  bus.on<pace_t>([this](const pace_t& message) { pace.hear(message, Clock::now()); });
  bus.on<status_t>([this](const status_t& status) {
    if (!statuses.contains(status.role)) check_room_for(status.role, statuses.size());
    statuses[status.role] = status;
    fresh_statuses.insert(status.role);
  });
  bus.on_missing([this](const request_t& request) {
    if (request.wanted_channel == Channel<run_config_t>::name) {
      if (!asked_for_config.contains(request.asker)) {
        check_room_for(request.asker, asked_for_config.size());
      }
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
