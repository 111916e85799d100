#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <string>

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
  std::optional<Clock::time_point> first_goal;
  std::optional<Clock::time_point> last_commit;

  HeardPace pace;

  /// Whether somebody who watches the run has paused it, so that nothing is to be waited for.
  bool paused() const;

  /// Has everything of the run that the bus delivers come here; this must outlive the bus's
  /// handlers and stay where it is.
  void listen(Bus& bus);
};

}  // namespace nextview
