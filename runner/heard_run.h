#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <type_traits>

#include "lcmtypes/bus.h"
#include "lcmtypes/heard_pace.h"
#include "logger/run_record.h"

namespace nextview {

/// What has been heard of a run on its bus, and when.
struct HeardRun {
  using Clock = std::chrono::steady_clock;

  RunRecord record{RangeImages::Keep};
  std::set<std::string> asked_for_config;    ///< roles
  std::map<std::string, status_t> statuses;  ///< by role, as last heard
  std::set<std::string> fresh_statuses;      ///< roles heard of since this was cleared
  Clock::time_point last_progress;           ///< when something new of the run came
  std::map<std::string, int> worked_on;      ///< by role: latest view it has said a timing of
  std::optional<Clock::time_point> first_goal;
  std::optional<Clock::time_point> last_commit;

  /// The latest view that anything was said of, be it taken or refused; at most the run's last.
  int spoken_of = 0;
  /// Whether a view is over for the others that has not been heard to the end here.
  bool is_behind() const { return spoken_of > record.committed_views() + 1; }

  HeardPace pace;
  bool ending = false;  ///< this process ends the run itself: no other end counts

  /// Whether somebody who watches the run has paused it, so that nothing is to be waited for.
  bool paused() const;
  /// Called with every request that this process's bus does not answer.
  std::function<void(const request_t&)> on_missing;

  /// Has everything of the run that the bus delivers come here; this must outlive the bus's
  /// handlers and stay where it is.
  void listen(Bus& bus);
  /// Something new of the run has come.
  template <class Message>
  void take(const Message& message) {
    record.add(message);
    last_progress = Clock::now();
    if constexpr (std::is_same_v<Message, goal_t>) {
      if (!first_goal) first_goal = last_progress;
    }
    if constexpr (std::is_same_v<Message, commit_t>) last_commit = last_progress;
  }

 private:
  template <class Message>
  void note_view(const Message& message) {
    if (!record.config()) return;
    const int view = key_of(message).view;
    if (view <= record.config()->planner.max_views) spoken_of = std::max(spoken_of, view);
  }
};

}  // namespace nextview
