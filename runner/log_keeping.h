#pragma once

#include <chrono>
#include <optional>
#include <set>

#include "lcmtypes/bus.h"
#include "logger/log_answers.h"
#include "logger/run_log.h"
#include "runner/heard_run.h"

namespace nextview {

/// Sees to it beside the run that its log gets whole: has what the recorder missed published again,
/// says up to which view all is there (recorded_t), and answers for those views out of the log, so
/// that neither their publishers nor this process need to keep what they said.
class LogKeeping {
 public:
  /// Looks at the log, if it is time; to be called often.
  void step(RunLog& log, Bus& bus, HeardRun& heard);
  /// Has what was missed here, and is of a view that this answers for, come out of the log; false
  /// when it is of another.
  bool take_from_log(const MissingMessage& missing, HeardRun& heard);
  /// Has all of a view that this answers for come out of the log, of whose messages none has come
  /// here; false when it is another.
  bool take_view_from_log(int view, HeardRun& heard);
  /// Answers a request for a view that it answers for; false for another.
  bool answer(Bus& bus, const request_t& request);

 private:
  using Clock = std::chrono::steady_clock;

  void ask_for_missed(const RunLog& log, Bus& bus, const HeardRun& heard);
  void settle(RunLog& log, Bus& bus, HeardRun& heard);

  std::optional<LogAnswers> answers_;
  std::set<MissingMessage> missed_;  ///< when last looked
  Clock::time_point next_look_;
};

}  // namespace nextview
