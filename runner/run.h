#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "lcmtypes/bus.h"
#include "logger/run_log.h"
#include "report/progress.h"
#include "report/run_report.h"
#include "runner/port_lock.h"
#include "runner/run_processes.h"
#include "runner/run_setup.h"

namespace nextview {

/// One run from the outside: starts the processes and the recorder, watches them, sees to it that
/// the log has everything, and ends them, however the run goes.
class Run {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param folder of the artefacts, which must not hold a log yet
  Run(const RunOptions& options, RunSetup setup, const std::filesystem::path& folder,
      Progress& progress);
  ~Run();

  /// Carries the run out.
  /// @throws SetupError or BusError when it cannot start
  FinishedRun carry_out(Clock::time_point program_start);

 private:
  /// Thrown when the run cannot go on to its own end.
  struct EndsEarly {
    StopReason reason;
    std::string detail;
  };

  void subscribe();
  void start_up();
  bool recording();
  void start_scoring();
  void watch();
  void complete_log();
  void collect_statuses();
  /// What has been heard, or must have been said, and is not in the log.
  std::set<MissingMessage> lacking_in_log() const;
  void read_log_to_its_end();
  void end_early(const EndsEarly& end);
  FinishedRun finish(Clock::time_point program_start);

  template <class Condition>
  void pump_until(const Condition& condition);
  void pump(std::chrono::milliseconds timeout);
  void check_on_processes();
  template <class Message>
  void add(const Message& message);
  void request(const MissingMessage& missing);
  void make_rows();
  std::string waited_for() const;
  std::string who_is(const std::string& role) const;

  RunOptions options_;
  std::vector<std::string> answering_;  ///< roles of the processes that answer the planner
  RunSetup setup_;
  ArtefactFiles files_;
  Progress& progress_;

  std::optional<PortLock> port_;
  std::string lcm_url_;
  std::unique_ptr<Bus> bus_;
  std::optional<RunProcesses> processes_;
  std::optional<RunLog> log_;

  RunRecord record_{RangeImages::Keep};
  ViewRows rows_;
  std::set<std::string> asked_for_config_;  ///< roles
  std::map<std::string, status_t> statuses_;
  std::set<std::string> fresh_statuses_;  ///< roles heard of since this was cleared
  Clock::time_point last_progress_;
  std::optional<Clock::time_point> first_goal_;
  std::optional<Clock::time_point> last_commit_;
  std::optional<EndsEarly> ended_early_;

  std::future<NearSurface> near_coming_;
  bool near_known_ = false;
  std::future<VisibleSurface> visible_coming_;
  std::optional<VisibleSurface> visible_;
  std::string coverage_unknown_;  ///< why, when it cannot be worked out
  std::shared_ptr<VisibilityProgress> scoring_progress_ = std::make_shared<VisibilityProgress>();
  std::jthread scoring_;
};

}  // namespace nextview
