#pragma once

#include <functional>

#include "logger/run_log.h"
#include "reports/progress.h"
#include "runner/ends_early.h"
#include "runner/heard_run.h"
#include "runner/log_mending.h"
#include "runner/restart_limit.h"
#include "runner/run_folder.h"
#include "runner/run_processes.h"

namespace nextview {

/// Starts other processes of a run in the place of those that have ended though they should not
/// have, and makes good what the recorder has missed by it.
class Replacements {
 public:
  /// Reads on in the log of the run; null while its recorder has not begun it.
  /// @throws LogError when it cannot be read
  using ReadLog = std::function<RunLog*()>;

  /// @param folder of the run; it and progress must outlive this
  Replacements(const RunFolder& folder, Progress& progress)
      : folder_(folder), progress_(progress) {}

  /// Starts another process, which goes on where that one was, and says so.
  /// @throws EndsEarly saying why nobody stands in for it: a planner of the user's own, a log that
  ///         can be written no more, one that keeps ending without the run getting on
  void stand_in_for(const Casualty& casualty, RunProcesses& processes, HeardRun& heard,
                    const ReadLog& read_log);
  /// Makes good what the recorder has missed; to be called often.
  void mend(RunLog& log, Bus& bus, const HeardRun& heard) { log_mending_.step(log, bus, heard); }
  /// Whether more than one recorder has written the log.
  bool recorder_began_anew() const { return recorder_began_anew_; }

 private:
  const RunFolder& folder_;
  Progress& progress_;
  RestartLimit restart_limit_;
  LogMending log_mending_;
  bool recorder_began_anew_ = false;
};

}  // namespace nextview
