#include "runner/replacements.h"

#include <fmt/format.h>

#include "reports/run_report.h"
#include "runner/disk_room.h"
#include "runner/run_setup.h"

namespace nextview {
namespace {

/// Why a recorder cannot go on with a log; what one has left of a message is cut off.
std::optional<std::string> why_log_ends_here(const Replacements::ReadLog& read_log,
                                             const std::filesystem::path& file) {
  try {
    if (RunLog* const log = read_log()) log->cut_rest();
  } catch (const LogError& error) {
    return error.what();
  }
  return why_no_more_fits(file);
}

std::int64_t messages_in(const RunLog* log) {
  return log ? static_cast<std::int64_t>(log->record().held().size()) : 0;
}

}  // namespace

void Replacements::stand_in_for(const Casualty& casualty, RunProcesses& processes, HeardRun& heard,
                                const ReadLog& read_log) {
  const std::string& role = casualty.role;
  const auto dies = [&](const std::string& why) {
    throw EndsEarly{StopReason::ProcessDied, casualty.account + "\n" + why};
  };
  if (role == RunProcesses::kPlanner && processes.has_own_planner()) {
    dies("A planner of your own is not started again: it might decide otherwise.");
  }
  std::int64_t progress = heard.record.committed_views();
  const bool recorder = role == RunProcesses::kRecorder;
  if (recorder) {
    const std::filesystem::path file = ArtefactFiles(folder_.path()).log;
    if (const auto why = why_log_ends_here(read_log, file)) {
      dies(fmt::format("{}: {}. Mend that, and go on with the run by --resume {}", file.string(),
                       *why, folder_.path().string()));
    }
    progress = messages_in(read_log());
  }
  if (!restart_limit_.allows(role, progress)) {
    dies(fmt::format("It was started again {} times, and did not get on.", RestartLimit::kTries));
  }
  progress_.say(casualty.account + "\nIt is started again.");
  heard.worked_on.erase(role);
  heard.last_progress = HeardRun::Clock::now();
  try {
    processes.restart(role, heard.record.latest_view());
  } catch (const SetupError& error) {
    dies(error.what());
  }
  if (recorder) {
    recorder_began_anew_ = true;
    log_mending_.begin();
  }
}

}  // namespace nextview
