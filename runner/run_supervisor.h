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
#include "runner/background_scoring.h"
#include "runner/heard_run.h"
#include "runner/port_lock.h"
#include "runner/run_processes.h"
#include "runner/run_setup.h"
#include "runner/viewer_process.h"
#include "scoring/near_surface.h"

namespace nextview {

/// Carries out one run from the outside: starts the processes and the recorder, watches them, sees
/// to it that the log has everything, and ends them, however the run goes.
class RunSupervisor {
 public:
  using Clock = HeardRun::Clock;

  /// @param folder of the artefacts, which must not hold a log yet
  RunSupervisor(const RunOptions& options, RunSetup setup, const std::filesystem::path& folder,
                Progress& progress);
  ~RunSupervisor();

  /// Carries the run out.
  /// @throws SetupError or BusError when it cannot start
  FinishedRun carry_out(Clock::time_point program_start);
  /// After the run, with --view: waits until the viewer has ended, or a signal ends it.
  void show_until_closed();

 private:
  /// Thrown when the run cannot go on to its own end.
  struct EndsEarly {
    StopReason reason;
    std::string detail;
  };

  void start_up();
  void join_bus();
  void start_viewer();
  bool recording();
  void start_scoring();
  void watch();
  void complete_log();
  void collect_statuses();
  void end_early(const EndsEarly& end);
  void wait_for_scoring();
  FinishedRun finish(Clock::time_point program_start);
  void end_processes(FinishedRun& run);
  std::string why_coverage_is_unknown() const;
  std::string why_precision_is_unknown() const;
  void add_bounds(FinishedRun& run) const;

  template <class Condition>
  void pump_until(const Condition& condition);
  void pump(std::chrono::milliseconds timeout);
  /// With --real-time: what the motion and scan under way may take without a word.
  double watched_motion_s() const;
  void check_on_processes();
  void make_rows(std::chrono::milliseconds wait_for_scoring = std::chrono::milliseconds(0));

  RunOptions options_;
  std::vector<std::string> answering_;  ///< roles of the processes that answer the planner
  RunSetup setup_;
  ArtefactFiles files_;
  Progress& progress_;

  HeardRun heard_;
  ViewRows rows_;
  std::optional<PortLock> port_;
  std::string lcm_url_;
  std::unique_ptr<Bus> bus_;
  std::optional<RunProcesses> processes_;
  std::optional<ViewerProcess> viewer_;
  std::optional<RunLog> log_;
  std::optional<EndsEarly> ended_early_;

  std::optional<BackgroundScoring<NearSurface>> near_surface_;
  std::optional<BackgroundScoring<VisibleSurface>> scoring_;
  bool near_known_ = false;
  std::optional<VisibleSurface> visible_;
};

}  // namespace nextview
