#include "runner/run_supervisor.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <random>
#include <set>
#include <thread>
#include <utility>

#include "lcmtypes/ask_timer.h"
#include "lcmtypes/part_size.h"
#include "runner/finished_log.h"
#include "runner/give_way.h"
#include "runner/log_completion.h"
#include "runner/private_network.h"
#include "runner/run_outcome.h"
#include "runner/run_signals.h"
#include "runner/waited_for.h"
#include "scoring/kept_file.h"

namespace nextview {
namespace {

using std::chrono::milliseconds;
using Clock = RunSupervisor::Clock;

double seconds_between(Clock::time_point start, Clock::time_point end) {
  return std::chrono::duration<double>(end - start).count();
}

/// Tells runs apart on a bus they share; of no influence on what a run does.
std::int64_t new_run_number() {
  std::random_device random;
  return static_cast<std::int64_t>((std::uint64_t{random()} << 31 ^ random()) >> 1) + 1;
}

/// Whether all of these roles are among those heard of. Others may take part too: a viewer, say.
bool all_of(const std::set<std::string>& roles, const std::set<std::string>& heard_of) {
  return std::includes(heard_of.begin(), heard_of.end(), roles.begin(), roles.end());
}

/// How long something must be missing before it is asked for, where nobody waits for it to go on.
constexpr milliseconds kLeastMissed{50};

/// Likewise while the others have gone on to views of which this process has not heard.
constexpr milliseconds kLeastBehind{10};

/// Within this time the recorder writes the next message, if it has one to write.
constexpr milliseconds kLeastWritten{20};

/// Waits from first on up to two seconds.
AskTimer reminder_after(milliseconds first) { return AskTimer(first, milliseconds(2000)); }

/// @param part_bytes of range images, as sensor_sim --part-bytes has it
RoleOptions role_options(const RunOptions& options, const RunSetup& setup, std::size_t part_bytes) {
  RoleOptions by_role;
  by_role["mapper"] = setup.mapper_options;
  if (options.real_time > 0.0) {
    const std::string real_time = fmt::format("--real-time={}", options.real_time);
    by_role["base_sim"] = by_role["sensor_sim"] = {real_time};
  }
  if (part_bytes != kPartBytes) {
    by_role["sensor_sim"].push_back(fmt::format("--part-bytes={}", part_bytes));
  }
  if (!options.key_file.empty()) {
    const auto file = std::filesystem::absolute(options.key_file);
    for (const char* role : {"sensor_sim", "base_sim", "mapper", "planner"}) {
      by_role[role].push_back("--key-file=" + file.string());
    }
  }
  return by_role;
}

}  // namespace

RunSupervisor::RunSupervisor(const RunOptions& options, RunNetwork network, RunSetup setup,
                             RunFolder folder, std::optional<EarlierRun> earlier,
                             Progress& progress)
    : options_(options),
      network_(std::move(network)),
      key_(run_key_of(options)),
      answering_(answering_roles(options.without)),
      setup_(std::move(setup)),
      folder_(std::move(folder)),
      files_(folder_.path()),
      earlier_(std::move(earlier)),
      progress_(progress),
      rows_(setup_.config),
      replacements_(folder_, progress_),
      scoring_(setup_, cache_folder(options.cache), !options.no_coverage) {
  if (!earlier_) setup_.config.run = new_run_number();
}

RunSupervisor::~RunSupervisor() {
  if (processes_) processes_->end_all();
}

FinishedRun RunSupervisor::carry_out(Clock::time_point program_start) {
  try {
    if (earlier_) take_up_again();
    if (earlier_ && earlier_->is_whole()) {
      scoring_.start();  // only its tables are missing
    } else {
      start_up();
      do {
        watch();
        complete_log();
        collect_statuses();
      } while (!heard_.record.stop());  // a planner that says how it is, and has gone on
    }
  } catch (const EndsEarly& end) {
    end_early(end);
  } catch (const BusError& error) {
    if (!heard_.record.config()) throw;  // nothing has begun
    end_early({StopReason::BusFailed, error.what()});
  }
  return finish(program_start);
}

void RunSupervisor::join_bus() {
  lcm_url_ = options_.lcm_url;
  if (const char* url = std::getenv("LCM_DEFAULT_URL"); lcm_url_.empty() && url != nullptr) {
    lcm_url_ = url;
  }
  if (lcm_url_.empty()) {
    port_ = PortLock::acquire();
    lcm_url_ = port_->lcm_url();
  }
  bus_ = std::make_unique<Bus>(lcm_url_, setup_.config.run, "run", key_);
  heard_.on_missing = [this](const request_t& request) {
    if (!log_keeping_.answer(*bus_, request) && earlier_) earlier_->answer(*bus_, request);
  };
  heard_.listen(*bus_);
}

template <class Condition>
void RunSupervisor::pump_until(const Condition& condition) {
  AskTimer reminder = reminder_after(milliseconds(5));
  while (!condition()) {
    if (reminder.due()) bus_->request<status_t>(0, 0);
    pump(milliseconds(5));
  }
}

void RunSupervisor::take_up_again() {
  heard_.record.add(setup_.config);
  earlier_->tell([this](const auto& message) {
    try {
      heard_.record.add(message);
    } catch (const RejectedMessage&) {
      return;  // as when it was said
    }
    make_rows();  // no range image is kept for longer than it is needed
  });
  reached_ = heard_.record.latest_view();
  recording();
  logged_before_ = log_->counters().ours;
  progress_.say(fmt::format("goes on after view {}", heard_.record.committed_views()));
}

void RunSupervisor::start_up() {
  join_bus();
  const std::size_t earlier_parts = earlier_ ? earlier_->part_bytes() : 0;
  const RoleOptions options =
      role_options(options_, setup_, earlier_parts > 0 ? earlier_parts : part_bytes_on(lcm_url_));
  std::vector<std::string> started = answering_;
  for (const std::string& role : options_.elsewhere) std::erase(started, role);
  processes_.emplace(lcm_url_, setup_.config.run, files_.log, started, reached_, folder_.lock(),
                     options);
  if (options_.verbose || !options_.without.empty()) {
    progress_.say(fmt::format("bus: {}, run {}", lcm_url_, setup_.config.run));
  }
  if (network_.own) {
    progress_.say(fmt::format("in a network of its own, which ./spy and this join: {} COMMAND",
                              command_to_join_network_of(::getpid())));
  }
  if (!network_.note.empty()) progress_.say(network_.note);

  for (const std::string& role : options_.elsewhere) {
    progress_.say("start it by hand: " + processes_->command_of(role, reached_));
  }
  start_viewer();

  // Nothing is known about a run before its configuration is, so the run starts with it: not before
  // all processes have asked for it, and requests are seen to arrive in the log.
  heard_.last_progress = Clock::now();
  const std::set<std::string> answering(answering_.begin(), answering_.end());
  pump_until([&] {
    const bool viewer_ready =
        !viewer_ || !viewer_->running() || heard_.asked_for_config.contains(ViewerProcess::kRole);
    return recording() && viewer_ready && all_of(answering, heard_.asked_for_config);
  });
  heard_.record.add(setup_.config);
  bus_->publish(setup_.config);
  heard_.last_progress = Clock::now();
  scoring_.start();
  // Each says so when it has loaded what it needs; only then is there somebody to hear a goal. With
  // its configuration in the log a run can be taken up again, whatever becomes of this process.
  AskTimer config_again = reminder_after(milliseconds(20));
  pump_until(
      [&] { return config_recorded(config_again) && all_of(answering, heard_.fresh_statuses); });
  // Who has paused the run before its first view may not be heard by a planner that only starts.
  pump_until([&] { return !heard_.pace.holds(reached_ + 1, Clock::now()); });
  processes_->start_planner(options_.planner, reached_);
  for (const std::string& note : setup_.notes) progress_.say(note);
  heard_.last_progress = Clock::now();
}

void RunSupervisor::start_viewer() {
  if (!options_.view) return;
  viewer_.emplace(lcm_url_, setup_.config.run, options_.key_file, options_.paused,
                  network_.page.get());
  network_.page.reset();
}

void RunSupervisor::show_until_closed() {
  if (!viewer_ || !viewer_->running()) return;
  progress_.say("the page stays there to be looked at until Ctrl-C: " + viewer_->address());
  while (viewer_->running() && noted_signal() == 0) {
    for (const std::string& line : viewer_->take_lines()) progress_.say(line);
    std::this_thread::sleep_for(milliseconds(50));
  }
  viewer_.reset();
}

bool RunSupervisor::recording() {
  if (!log_ && std::filesystem::exists(files_.log)) {
    log_.emplace(files_.log, setup_.config.run, RangeImages::OnlyCount, key_);
  }
  if (log_) log_->read_on();
  return log_ && log_->counters().ours > logged_before_;
}

bool RunSupervisor::config_recorded(AskTimer& reminder) {
  log_->read_on();
  if (log_->record().config()) return true;
  if (reminder.due()) bus_->publish(setup_.config);
  return false;
}

void RunSupervisor::watch() {
  give_way();  // from here on this process only looks on
  // Most often nothing is lost and somebody works: then less and less often.
  AskTimer reminder = reminder_after(kLeastMissed);
  const RunRecord& record = heard_.record;
  bool behind = false;
  while (!record.stop() || !record.missing().empty()) {
    pump(behind ? kLeastBehind : milliseconds(20));
    replacements_.mend(*log_, *bus_, heard_);
    log_keeping_.step(*log_, *bus_, heard_);
    make_rows();
    if (!std::exchange(behind, heard_.is_behind()) && behind) reminder.restart(kLeastBehind);
    if (!reminder.due() || !take_all_there_is()) continue;
    if (ask_for_missed()) {
      reminder.restart(behind ? kLeastBehind
                              : std::max(kLeastMissed, 2 * bus_->response_time().timeout()));
    }
  }
  make_rows();
}

/// @return whether nothing waits to be taken any more: whoever is behind has not missed anything
bool RunSupervisor::take_all_there_is() {
  constexpr int kAtATime = 1000;
  int taken = 0;
  while (taken < kAtATime && bus_->handle(milliseconds(0))) ++taken;
  make_rows();
  return taken < kAtATime;
}

/// @return whether something has come since
bool RunSupervisor::ask_for_missed() {
  // Of a view that is in the log nobody else keeps anything, and nobody here may know of it.
  while (heard_.is_behind()) {
    const int view = heard_.record.committed_views() + 1;
    if (heard_.record.latest_view() >= view || !log_keeping_.take_view_from_log(view, heard_)) {
      break;
    }
    make_rows();
  }
  // What was missing when it was looked before, too, unless all others have it for certain: what
  // only this listener has missed nobody else makes good.
  std::set<MissingMessage> missed;
  for (const MissingMessage& missing : heard_.record.missing()) {
    if (log_keeping_.take_from_log(missing, heard_)) continue;
    if (missed_.contains(missing) || heard_.is_behind()) request(*bus_, missing, heard_.record);
    missed.insert(missing);
  }
  const bool come = !std::includes(missed.begin(), missed.end(), missed_.begin(), missed_.end());
  missed_ = std::move(missed);
  return come;
}

void RunSupervisor::make_rows(milliseconds wait_for_scoring) {
  scoring_.give_to(rows_, wait_for_scoring);
  while (const ViewRow* row = rows_.advance(heard_.record)) progress_.show(*row);
}

void RunSupervisor::complete_log() {
  // The recorder writes out what it holds when something more comes: the request and its answers.
  bus_->request<status_t>(0, 0);
  AskTimer reminder = reminder_after(milliseconds(20));
  heard_.last_progress = Clock::now();
  std::vector<MissingMessage> had_missing;
  std::int64_t read = 0;
  for (;;) {
    log_->read_on();
    const auto& stop = heard_.record.stop();
    if (!stop) return;  // it was none
    // What a stranger has said of views there are not need not be made whole.
    std::vector<MissingMessage> missing = log_->record().missing();
    std::erase_if(
        missing, [&stop](const MissingMessage& message) { return message.view > stop->views + 1; });
    if (missing.empty()) return;
    // What is asked for is recorded too: the log grows, and is none the better for it.
    if (missing != had_missing) heard_.last_progress = Clock::now();
    had_missing = missing;
    // A recorder that still writes is behind, and may not have missed anything.
    if (const std::int64_t position = log_->position(); position != std::exchange(read, position)) {
      reminder.restart(std::max(kLeastWritten, bus_->response_time().timeout()));
    }
    if (reminder.due()) {
      for (const MissingMessage& message : missing) {
        if (!publish_again(*bus_, message, heard_.record)) {
          request(*bus_, message, log_->record());
        }
      }
    }
    try {
      pump(milliseconds(5));
    } catch (const EndsEarly& end) {
      if (end.reason != StopReason::NoAnswer) throw;
      throw EndsEarly{end.reason, "the log still lacks " + describe(missing.front()) +
                                      ", however often it was asked for"};
    }
  }
}

void RunSupervisor::collect_statuses() {
  heard_.fresh_statuses.clear();
  AskTimer reminder = reminder_after(milliseconds(50));
  bus_->request<status_t>(0, 0);
  // Only for the summary, so a process that does not answer is not waited for very long.
  const auto until = Clock::now() + milliseconds(1000);
  std::set<std::string> roles(answering_.begin(), answering_.end());
  roles.insert("planner");
  while (!all_of(roles, heard_.fresh_statuses) && Clock::now() < until) {
    pump(milliseconds(5));
    if (reminder.due()) bus_->request<status_t>(0, 0);
  }
}

void RunSupervisor::end_early(const EndsEarly& end) {
  heard_.ending = true;
  ended_early_ = end;
  if (!processes_ || !bus_) return;
  processes_->end_planner();
  try {
    if (!log_ || !heard_.record.config()) return;
    log_early_end(end, *log_, *bus_, heard_);
    make_rows();
  } catch (const std::exception& error) {
    progress_.say(std::string("the end of the run could not be logged: ") + error.what());
  }
}

void RunSupervisor::put_log_in_order() {
  if (!log_) return;
  const bool began_anew = earlier_ || replacements_.recorder_began_anew();
  for (const std::string& what : finish_log(*log_, files_.log, began_anew)) {
    progress_.say(what);
  }
}

void RunSupervisor::end_processes(FinishedRun& run) {
  if (processes_) {
    processes_->end_all();
    put_log_in_order();
    const auto lines = processes_->take_lines();  // lcm-logger says goodbye
    if (options_.verbose) {
      for (const std::string& line : lines) progress_.say(line);
    }
    run.peak_memory_bytes = processes_->peak_memory_bytes();
  } else {
    put_log_in_order();  // of an earlier run, that may have been killed before it did
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  run.peak_memory_bytes["run"] = std::int64_t{usage.ru_maxrss} * 1024;
}

void RunSupervisor::wait_for_scoring() {
  AskTimer patience = reminder_after(milliseconds(1000));
  int said_percent = -1;
  while (scoring_.pending() && noted_signal() == 0 && !ended_early_) {
    make_rows(milliseconds(50));
    if (!scoring_.coverage_pending() || !patience.due()) continue;
    const int percent = scoring_.percent();
    if (percent == said_percent) continue;
    said_percent = percent;
    progress_.say(fmt::format(
        "working out how much of the scene can be seen at all, for the coverage, which Ctrl-C "
        "leaves out: {} %",
        percent));
  }
  scoring_.request_stop();
}

void RunSupervisor::add_bounds(FinishedRun& run) const {
  if (!setup_.scene) return;
  run.bounds = kept_view_bounds(cache_folder(options_.cache), setup_.config.scene_digest,
                                bound_question_of(options_, setup_.config))
                   .value_or(std::vector<ViewBound>());
  run.bound_command = options_.bound_command;
}

FinishedRun RunSupervisor::finish(Clock::time_point program_start) {
  FinishedRun run;
  end_processes(run);
  wait_for_scoring();
  const RunRecord& record = heard_.record;
  if (record.config()) rows_.complete(record);

  run.config = setup_.config;
  run.rows = rows_.rows();
  run.map_memory_bytes = rows_.map_memory_bytes();
  run.visible = scoring_.visible();
  run.coverage_unknown = scoring_.why_coverage_is_unknown();
  run.precision_unknown = scoring_.why_precision_is_unknown(run.rows);
  add_bounds(run);
  run.statuses = heard_.statuses;
  run.lcm_url = lcm_url_;
  if (log_) run.log = log_->counters();
  count_refusals(record, run);
  tell_end(record, ended_early_, run);
  if (heard_.first_goal) run.start_up_s = seconds_between(program_start, *heard_.first_goal);
  if (heard_.first_goal && heard_.last_commit) {
    run.first_goal_to_last_commit_s = seconds_between(*heard_.first_goal, *heard_.last_commit);
  }
  run.wall_s = seconds_between(program_start, Clock::now());
  return run;
}

void RunSupervisor::pump(milliseconds timeout) {
  bus_->handle(timeout);
  check_on_processes();
  if (noted_signal() != 0) {
    throw EndsEarly{StopReason::Interrupted, "The run was interrupted by a signal."};
  }
  if (heard_.paused()) heard_.last_progress = Clock::now();
  if (seconds_between(heard_.last_progress, Clock::now()) >
      options_.patience_s + watched_motion_s(heard_.record, setup_.config, options_.real_time)) {
    throw EndsEarly{StopReason::NoAnswer,
                    fmt::format("{} for {} s (--patience)", waited_for(heard_, answering_),
                                std::lround(options_.patience_s))};
  }
}

void RunSupervisor::check_on_processes() {
  if (viewer_) {
    viewer_->running();  // whether or not it does, the run goes on
    for (const std::string& line : viewer_->take_lines()) progress_.say(line);
  }
  if (!processes_) return;
  const std::optional<Casualty> casualty = processes_->casualty();
  for (const std::string& line : processes_->take_lines()) progress_.say(line);
  if (!casualty) return;
  take_all_there_is();  // how far the run has got is what the new process is told
  replacements_.stand_in_for(*casualty, *processes_, heard_, [this] {
    recording();
    return log_ ? &*log_ : nullptr;
  });
}

}  // namespace nextview
