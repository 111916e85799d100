#include "runner/run.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <random>
#include <utility>

#include "base_sim/base.h"
#include "lcmtypes/ask_timer.h"
#include "mapper/mapper_config.h"
#include "runner/run_signals.h"
#include "scoring/kept_file.h"
#include "scoring/visible_surface.h"
#include "sensor/sensor_config.h"

namespace nextview {
namespace {

using std::chrono::milliseconds;

double seconds_between(Run::Clock::time_point start, Run::Clock::time_point end) {
  return std::chrono::duration<double>(end - start).count();
}

/// Tells runs apart on a bus they share; of no influence on what a run does.
std::int64_t new_run_number() {
  std::random_device random;
  return static_cast<std::int64_t>((std::uint64_t{random()} << 31 ^ random()) >> 1) + 1;
}

/// Looking on and scoring must not take time from the processes that do the work: on two cores the
/// share of a run that is waiting falls by a quarter.
void give_way() { setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), 15); }

/// Whether all of these roles are among those heard of. Others may take part too: a viewer, say.
bool all_of(const std::set<std::string>& roles, const std::set<std::string>& heard_of) {
  return std::includes(heard_of.begin(), heard_of.end(), roles.begin(), roles.end());
}

/// Waits from first on up to two seconds.
AskTimer reminder_after(milliseconds first) { return AskTimer(first, milliseconds(2000)); }

}  // namespace

Run::Run(const RunOptions& options, RunSetup setup, const std::filesystem::path& folder,
         Progress& progress)
    : options_(options),
      answering_(answering_roles(options.without)),
      setup_(std::move(setup)),
      files_(folder),
      progress_(progress),
      rows_(setup_.config) {
  setup_.config.run = new_run_number();
}

Run::~Run() {
  if (processes_) processes_->end_all();
}

FinishedRun Run::carry_out(Clock::time_point program_start) {
  try {
    start_up();
    watch();
    complete_log();
    collect_statuses();
  } catch (const EndsEarly& end) {
    end_early(end);
  } catch (const BusError& error) {
    if (!record_.config()) throw;  // nothing has begun
    end_early({StopReason::BusFailed, error.what()});
  }
  return finish(program_start);
}

void Run::subscribe() {
  bus_->on<goal_t>([this](const goal_t& goal) {
    add(goal);
    if (!first_goal_) first_goal_ = Clock::now();
  });
  bus_->on<search_t>([this](const search_t& search) { add(search); });
  bus_->on<arrival_t>([this](const arrival_t& arrival) { add(arrival); });
  bus_->on<range_image_t>([this](const range_image_t& part) { add(part); });
  bus_->on<commit_t>([this](const commit_t& commit) {
    add(commit);
    last_commit_ = Clock::now();
  });
  bus_->on<stop_t>([this](const stop_t& stop) { add(stop); });
  bus_->on<timing_t>([this](const timing_t& timing) { record_.add(timing); });
  bus_->on<status_t>([this](const status_t& status) {
    statuses_[status.role] = status;
    fresh_statuses_.insert(status.role);
  });
  bus_->on_missing([this](const request_t& request) {
    if (request.wanted_channel == Channel<run_config_t>::name) {
      asked_for_config_.insert(request.asker);
    }
  });
}

template <class Message>
void Run::add(const Message& message) {
  record_.add(message);
  last_progress_ = Clock::now();
}

template <class Condition>
void Run::pump_until(const Condition& condition) {
  AskTimer reminder = reminder_after(milliseconds(5));
  while (!condition()) {
    if (reminder.due()) bus_->request<status_t>(0, 0);
    pump(milliseconds(5));
  }
}

void Run::start_up() {
  lcm_url_ = options_.lcm_url;
  if (const char* url = std::getenv("LCM_DEFAULT_URL"); lcm_url_.empty() && url != nullptr) {
    lcm_url_ = url;
  }
  if (lcm_url_.empty()) {
    port_ = PortLock::acquire();
    lcm_url_ = port_->lcm_url();
  }
  bus_ = std::make_unique<Bus>(lcm_url_, setup_.config.run, "run");
  subscribe();
  processes_.emplace(lcm_url_, setup_.config.run, files_.log, answering_);
  if (options_.verbose || !options_.without.empty()) {
    progress_.say("bus: " + lcm_url_ + ", run " + std::to_string(bus_->run()));
  }

  // Nothing is known about a run before its configuration is, so the run starts with it: not before
  // all processes have asked for it, and requests are seen to arrive in the log.
  last_progress_ = Clock::now();
  const std::set<std::string> answering(answering_.begin(), answering_.end());
  pump_until([&] { return recording() && all_of(answering, asked_for_config_); });
  record_.add(setup_.config);
  bus_->publish(setup_.config);
  last_progress_ = Clock::now();
  if (setup_.scene) start_scoring();
  // Each says so when it has loaded what it needs; only then is there somebody to hear a goal.
  pump_until([&] { return all_of(answering, fresh_statuses_); });
  processes_->start_planner();
  last_progress_ = Clock::now();
}

bool Run::recording() {
  if (!log_ && std::filesystem::exists(files_.log)) {
    log_.emplace(files_.log, setup_.config.run, RangeImages::OnlyCount);
  }
  if (log_) log_->read_on();
  return log_ && log_->counters().ours > 0;
}

void Run::start_scoring() {
  std::promise<NearSurface> near;
  std::promise<VisibleSurface> promise;
  near_coming_ = near.get_future();
  if (!options_.no_coverage) visible_coming_ = promise.get_future();
  scoring_ = std::jthread([scene = setup_.scene, config = setup_.config,
                           cache = cache_folder(options_.cache), progress = scoring_progress_,
                           coverage = !options_.no_coverage, near = std::move(near),
                           promise = std::move(promise)](const std::stop_token& stop) mutable {
    give_way();
    near.set_value(NearSurface(scene->mesh(), grid_of(config), window_of(config), stop));
    if (!coverage) return;
    try {
      promise.set_value(kept_visible_surface(cache, *scene, std::string(config.scene_digest),
                                             start_pose_of(config).position_m,
                                             visibility_of(config), stop, progress.get()));
    } catch (...) {
      promise.set_exception(std::current_exception());
    }
  });
}

void Run::watch() {
  give_way();  // from here on this process only looks on
  AskTimer reminder = reminder_after(milliseconds(300));
  auto reminded_since = last_progress_;
  while (!record_.stop() || !record_.missing().empty()) {
    pump(milliseconds(20));
    make_rows();
    if (reminded_since != last_progress_) {
      reminded_since = last_progress_;
      reminder.restart();
    }
    // Most often nothing is lost and somebody works; asking costs little, and else nobody would
    // make good what only this listener has missed.
    if (reminder.due()) {
      for (const MissingMessage& missing : record_.missing()) request(missing);
    }
  }
  make_rows();
}

void Run::make_rows() {
  if (near_coming_.valid() && near_coming_.wait_for(milliseconds(0)) == std::future_status::ready) {
    rows_.set_near(near_coming_.get());
    near_known_ = true;
  }
  if (!visible_ && visible_coming_.valid() &&
      visible_coming_.wait_for(milliseconds(0)) == std::future_status::ready) {
    try {
      visible_ = visible_coming_.get();
      rows_.set_visible(*visible_);
    } catch (const std::exception& error) {
      coverage_unknown_ = std::string("it could not be worked out: ") + error.what();
    }
  }
  while (const ViewRow* row = rows_.advance(record_)) progress_.show(*row);
}

void Run::complete_log() {
  // The recorder writes out what it holds when something more comes: the request and its answers.
  bus_->request<status_t>(0, 0);
  AskTimer reminder = reminder_after(milliseconds(20));
  last_progress_ = Clock::now();
  for (;;) {
    const std::int64_t had = log_->counters().ours;
    log_->read_on();
    const std::vector<MissingMessage> missing = log_->record().missing();
    if (missing.empty()) return;
    if (log_->counters().ours != had) last_progress_ = Clock::now();
    if (reminder.due()) {
      for (const MissingMessage& message : missing) request(message);
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

void Run::collect_statuses() {
  fresh_statuses_.clear();
  AskTimer reminder = reminder_after(milliseconds(50));
  bus_->request<status_t>(0, 0);
  // Only for the summary, so a process that does not answer is not waited for very long.
  const auto until = Clock::now() + milliseconds(1000);
  std::set<std::string> roles(answering_.begin(), answering_.end());
  roles.insert("planner");
  while (!all_of(roles, fresh_statuses_) && Clock::now() < until) {
    pump(milliseconds(5));
    if (reminder.due()) bus_->request<status_t>(0, 0);
  }
}

std::set<MissingMessage> Run::lacking_in_log() const {
  const RunRecord& logged = log_->record();
  std::set<MissingMessage> lacking;
  for (const MissingMessage& missing : logged.missing()) {
    if (missing.view > 0 && missing.view <= logged.views_taken()) lacking.insert(missing);
  }
  const std::vector<MissingMessage> in_log = logged.held();
  const std::set<MissingMessage> there(in_log.begin(), in_log.end());
  for (const MissingMessage& heard : record_.held()) {
    if (!there.contains(heard)) lacking.insert(heard);
  }
  return lacking;
}

void Run::read_log_to_its_end() {
  // The recorder is behind, and the view under way still counts. Neither is waited for when it does
  // not get on, nor for ever.
  constexpr milliseconds kQuiet{100};
  constexpr milliseconds kPatience{1000};
  constexpr milliseconds kLongest{10000};
  AskTimer reminder = reminder_after(milliseconds(20));
  const auto start = Clock::now();
  auto grew = start;
  std::size_t had = 0;
  for (;;) {
    bus_->handle(milliseconds(5));
    log_->read_on();
    const RunRecord& logged = log_->record();
    const auto now = Clock::now();
    if (const std::size_t has = logged.held().size(); has != had) {
      had = has;
      grew = now;
    }
    const std::set<MissingMessage> lacking = lacking_in_log();
    const bool whole = lacking.empty() && logged.latest_view() == logged.committed_views();
    if (now - grew > (whole ? kQuiet : kPatience) || now - start > kLongest) return;
    if (!reminder.due()) continue;
    bus_->request<status_t>(0, 0);  // the recorder writes out what it holds when more comes
    for (const MissingMessage& message : lacking) request(message);
  }
}

void Run::end_early(const EndsEarly& end) {
  ended_early_ = end;
  if (!processes_ || !bus_) return;
  processes_->end_planner();
  try {
    if (!log_ || !record_.config()) return;
    read_log_to_its_end();
    make_rows();
    if (const auto& recorded = log_->record().stop()) {  // heard here or not
      if (!record_.stop()) record_.add(*recorded);
      return;
    }
    // The planner has not ended the run, so that its log says how it ended somebody else must.
    stop_t stop{};
    stop.views = log_->record().views_taken();
    stop.stop_reason = std::string(to_string(end.reason));
    stop.detail = end.detail;
    bus_->publish(record_.stop().value_or(stop));
    const auto until = Clock::now() + milliseconds(1000);
    while (!log_->record().stop() && Clock::now() < until) {
      bus_->handle(milliseconds(5));
      log_->read_on();
    }
    make_rows();
  } catch (const std::exception& error) {
    progress_.say(std::string("the end of the run could not be logged: ") + error.what());
  }
}

FinishedRun Run::finish(Clock::time_point program_start) {
  FinishedRun run;
  if (processes_) {
    processes_->end_all();
    const auto lines = processes_->take_lines();  // lcm-logger says goodbye
    if (options_.verbose) {
      for (const std::string& line : lines) progress_.say(line);
    }
    run.peak_memory_bytes = processes_->peak_memory_bytes();
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  run.peak_memory_bytes["run"] = std::int64_t{usage.ru_maxrss} * 1024;
  AskTimer patience = reminder_after(milliseconds(1000));
  while ((near_coming_.valid() || visible_coming_.valid()) && noted_signal() == 0 &&
         !ended_early_) {
    if (near_coming_.valid()) {
      near_coming_.wait_for(milliseconds(50));
    } else {
      visible_coming_.wait_for(milliseconds(50));
    }
    make_rows();
    if (visible_coming_.valid() && patience.due()) {
      const std::int64_t of = std::max<std::int64_t>(1, scoring_progress_->of);
      progress_.say("working out how much of the scene can be seen at all, for the coverage: " +
                    std::to_string(100 * scoring_progress_->done / of) + " %");
    }
  }
  scoring_.request_stop();
  if (record_.config()) rows_.complete(record_);

  run.config = setup_.config;
  run.rows = rows_.rows();
  run.visible = visible_;
  run.coverage_unknown = coverage_unknown_;
  if (options_.no_coverage) run.coverage_unknown = "--no-coverage was given";
  if (!setup_.scene) run.coverage_unknown = "there is no CAD model to hold the map against";
  if (!visible_ && run.coverage_unknown.empty()) {
    run.coverage_unknown = "the run ended before it was worked out";
  }
  if (!setup_.scene) {
    run.precision_unknown = "there is no CAD model to hold the map against";
  } else if (!near_known_) {
    run.precision_unknown = "the run ended before it was worked out";
  } else if (run.rows.empty() || !run.rows.back().surface_precision) {
    run.precision_unknown = "nothing is Occupied";
  }
  if (setup_.scene) {
    run.bounds = kept_view_bounds(cache_folder(options_.cache), setup_.config.scene_digest,
                                  bound_question_of(options_, setup_.config))
                     .value_or(std::vector<ViewBound>());
    run.bound_command = options_.bound_command;
  }
  run.statuses = statuses_;
  run.lcm_url = lcm_url_;
  if (log_) run.log = log_->counters();
  for (const auto& [key, arrival] : record_.arrivals()) {
    if (arrival.arrived) continue;
    ++(arrival.refusal.starts_with(kCollision) ? run.collisions : run.other_refusals);
  }
  if (ended_early_) {
    run.stop_reason = to_string(ended_early_->reason);
    run.stop_detail = ended_early_->detail;
  } else {
    run.stop_reason = record_.stop()->stop_reason;
    run.stop_detail = record_.stop()->detail;
    if (!stop_reason_from_string(run.stop_reason)) {
      run.stop_detail = "The run was ended for the reason \"" + run.stop_reason +
                        "\", which this version of nextview_run does not know: start it with the "
                        "planner it was built with. " +
                        run.stop_detail;
    }
  }
  if (first_goal_) run.start_up_s = seconds_between(program_start, *first_goal_);
  if (first_goal_ && last_commit_) {
    run.first_goal_to_last_commit_s = seconds_between(*first_goal_, *last_commit_);
  }
  run.wall_s = seconds_between(program_start, Clock::now());
  return run;
}

void Run::pump(milliseconds timeout) {
  bus_->handle(timeout);
  check_on_processes();
  if (noted_signal() != 0) {
    throw EndsEarly{StopReason::Interrupted, "The run was interrupted by a signal."};
  }
  if (seconds_between(last_progress_, Clock::now()) > options_.patience_s) {
    throw EndsEarly{StopReason::NoAnswer, waited_for()};
  }
}

void Run::check_on_processes() {
  if (!processes_) return;
  const std::optional<std::string> casualty = processes_->casualty();
  for (const std::string& line : processes_->take_lines()) progress_.say(line);
  if (casualty) throw EndsEarly{StopReason::ProcessDied, *casualty};
}

void Run::request(const MissingMessage& missing) {
  for_each_channel([&]<class Message>() {
    if (missing.channel == Channel<Message>::name) {
      bus_->request<Message>(missing.view, missing.attempt);
    }
  });
}

std::string Run::who_is(const std::string& role) const {
  const bool own = std::find(answering_.begin(), answering_.end(), role) == answering_.end();
  return own ? "the driver in place of " + role : role;
}

std::string Run::waited_for() const {
  const std::string for_so_long =
      " for " + std::to_string(std::lround(options_.patience_s)) + " s (--patience)";
  if (!record_.config()) {
    std::string who;
    for (const std::string& role : answering_) {
      if (!asked_for_config_.contains(role)) who += (who.empty() ? "" : ", ") + role;
    }
    if (who.empty()) who = "lcm-logger, which has recorded nothing";
    return "nothing was heard of " + who + for_so_long;
  }
  for (const std::string& role : answering_) {
    if (!statuses_.contains(role)) return role + " did not get ready" + for_so_long;
  }
  const int view = record_.latest_view();
  int attempt = 0;
  while (record_.goal(view, attempt + 1)) ++attempt;
  const std::string of_view = " of view " + std::to_string(view);
  const arrival_t* arrival = record_.arrival(view, attempt);
  if (record_.commit(view) || view == 0 || (arrival && !arrival->arrived)) {
    return "the planner gave no goal after view " + std::to_string(view) + for_so_long;
  }
  if (!arrival) return who_is("base_sim") + " did not answer the goal" + of_view + for_so_long;
  if (!record_.range_image(view, attempt)) {
    return who_is("sensor_sim") + " sent no range image" + of_view + for_so_long;
  }
  return "the mapper did not commit the range image" + of_view + for_so_long;
}

}  // namespace nextview
