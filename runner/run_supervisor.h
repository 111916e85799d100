#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/bus.h"
#include "logger/run_log.h"
#include "reports/progress.h"
#include "reports/run_report.h"
#include "runner/earlier_run.h"
#include "runner/ends_early.h"
#include "runner/heard_run.h"
#include "runner/log_keeping.h"
#include "runner/port_lock.h"
#include "runner/replacements.h"
#include "runner/run_folder.h"
#include "runner/run_network.h"
#include "runner/run_processes.h"
#include "runner/run_scoring.h"
#include "runner/run_setup.h"
#include "runner/viewer_process.h"

namespace nextview {

/// Carries out one run from the outside: starts the processes and the recorder, watches them, sees
/// to it that the log has everything, and ends them, however the run goes.
class RunSupervisor {
 public:
  using Clock = HeardRun::Clock;

  /// @param network that the program has entered
  /// @param folder of the artefacts, which must not hold a log yet
  /// @param earlier the run to be taken up again, whose log it holds; nothing: a new one begins
  RunSupervisor(const RunOptions& options, RunNetwork network, RunSetup setup, RunFolder folder,
                std::optional<EarlierRun> earlier, Progress& progress);
  ~RunSupervisor();

  /// Carries the run out.
  /// @throws SetupError or BusError when it cannot start
  FinishedRun carry_out(Clock::time_point program_start);
  /// After the run, with --view: waits until the viewer has ended, or a signal ends it.
  void show_until_closed();

 private:
  void take_up_again();
  void start_up();
  void join_bus();
  void start_viewer();
  bool recording();
  bool config_recorded(AskTimer& reminder);
  void watch();
  bool take_all_there_is();
  bool ask_for_missed();
  void complete_log();
  void collect_statuses();
  void end_early(const EndsEarly& end);
  void wait_for_scoring();
  FinishedRun finish(Clock::time_point program_start);
  void end_processes(FinishedRun& run);
  void put_log_in_order();
  void add_bounds(FinishedRun& run) const;

  template <class Condition>
  void pump_until(const Condition& condition);
  void pump(std::chrono::milliseconds timeout);
  void check_on_processes();
  void make_rows(std::chrono::milliseconds wait_for_scoring = std::chrono::milliseconds(0));

  RunOptions options_;
  RunNetwork network_;
  std::optional<RunKey> key_;
  std::vector<std::string> answering_;  ///< roles of the processes that answer the planner
  RunSetup setup_;
  RunFolder folder_;
  ArtefactFiles files_;
  std::optional<EarlierRun> earlier_;
  int reached_ = 0;  ///< the view the earlier run had got to
  Progress& progress_;

  HeardRun heard_;
  ViewRows rows_;
  std::optional<PortLock> port_;
  std::string lcm_url_;
  std::unique_ptr<Bus> bus_;
  std::optional<RunProcesses> processes_;
  std::optional<ViewerProcess> viewer_;
  Replacements replacements_;
  std::optional<RunLog> log_;
  std::int64_t logged_before_ = 0;  ///< messages of the run that were in the log at the start
  LogKeeping log_keeping_;
  std::set<MissingMessage> missed_;  ///< when last looked
  std::optional<EndsEarly> ended_early_;
  RunScoring scoring_;
};

}  // namespace nextview
