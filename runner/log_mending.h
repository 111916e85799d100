#pragma once

#include "lcmtypes/ask_timer.h"
#include "lcmtypes/bus.h"
#include "logger/run_log.h"
#include "runner/heard_run.h"

namespace nextview {

/// Makes good what the recorder has missed while it was away, beside the run: has it published
/// again until the log holds all that was heard.
class LogMending {
 public:
  /// The recorder has been started again.
  void begin();
  /// Takes it one step on, if it is time; to be called often.
  void step(RunLog& log, Bus& bus, const HeardRun& heard);
  bool under_way() const { return under_way_; }

 private:
  static constexpr std::chrono::milliseconds kFirst{20};

  bool under_way_ = false;
  AskTimer timer_{kFirst, std::chrono::milliseconds(500)};
  std::size_t held_ = 0;  // by the log
};

}  // namespace nextview
