#include "runner/heard_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "lcmtypes/run_course.h"
#include "lcmtypes/validate.h"
#include "planner/termination.h"

namespace nextview {
namespace {

const run_config_t& config_of(const RunRecord& heard) {
  if (!heard.config()) throw RejectedMessage("it came before the run's configuration");
  return *heard.config();
}

/// Something has been said of a view though the one after the last that was committed has not been
/// heard to have been: this listener is behind, or a stranger speaks. What it misses of views it
/// knows to have begun it asks for itself.
TooEarly ahead(int committed, const std::string& what) {
  return {fmt::format("{} is ahead of the run, which has committed {}", what, committed),
          Channel<goal_t>::name, committed + 1, 0, TooEarly::Then::Forget};
}

/// No view is begun before the one before it has been committed.
void check_begun(int view, const RunRecord& heard) {
  const int committed = heard.committed_views();
  if (view > committed + 1) throw ahead(committed, fmt::format("view {}", view));
}

const goal_t& goal_of(int view, int attempt, const RunRecord& heard) {
  check_fits_run(config_of(heard), view, attempt);
  check_begun(view, heard);
  if (const goal_t* goal = heard.goal(view, attempt)) return *goal;
  throw TooEarly(fmt::format("no goal asked for view {}, attempt {}", view, attempt),
                 Channel<goal_t>::name, view, 0);
}

const arrival_t& arrival_of(int view, int attempt, const RunRecord& heard,
                            TooEarly::Then then = TooEarly::Then::AskAnew) {
  check_fits_run(config_of(heard), view, attempt);
  if (const arrival_t* arrival = heard.arrival(view, attempt)) return *arrival;
  throw TooEarly(fmt::format("no arrival led to view {}, attempt {}", view, attempt),
                 Channel<arrival_t>::name, view, attempt, then);
}

bool said_by_the_run(std::string_view reason) {
  constexpr std::array kByTheRun = {StopReason::BusFailed, StopReason::NoAnswer,
                                    StopReason::ProcessDied, StopReason::Interrupted};
  return std::ranges::any_of(kByTheRun,
                             [reason](StopReason own) { return to_string(own) == reason; });
}

/// Whether a planner that has ended after so many views has left no goal that is under way.
void check_no_goal_under_way(int view, const RunRecord& heard) {
  int attempt = 0;
  while (heard.goal(view, attempt + 1) != nullptr) ++attempt;
  if (attempt == 0) return;
  const arrival_t& arrival = arrival_of(view, attempt, heard);
  if (arrival.arrived != 0) {
    throw RejectedMessage(fmt::format("nobody decided it: view {} is under way", view));
  }
}

}  // namespace

void check_follows(const goal_t& goal, const RunRecord& heard) {
  check_fits_run(config_of(heard), goal.view, goal.attempt);
  check_begun(goal.view, heard);
  if (goal.attempt > 1) goal_of(goal.view, goal.attempt - 1, heard);
}

void check_follows(const search_t& search, const RunRecord& heard) {
  goal_of(search.view, search.attempt, heard);
}

void check_follows(const arrival_t& arrival, const RunRecord& heard) {
  if (arrival.utime < goal_of(arrival.view, arrival.attempt, heard).utime) {
    throw RejectedMessage("the robot arrived before it had a goal");
  }
}

void check_follows(const range_image_t& part, const RunRecord& heard) {
  check_raster(part, config_of(heard));
  check_begun(part.view, heard);
  check_taken_at(part, arrival_of(part.view, part.attempt, heard, TooEarly::Then::JudgeAgain));
}

void check_follows(const commit_t& commit, const RunRecord& heard) {
  check_begun(commit.view, heard);
  check_taken_at(commit, arrival_of(commit.view, commit.attempt, heard));
}

void check_follows(const stop_t& stop, const RunRecord& heard) {
  check_fits_run(config_of(heard), stop.views, stop.final_attempt);
  if (said_by_the_run(stop.stop_reason)) {
    throw RejectedMessage(stop.stop_reason + " is for the run itself to say");
  }
  const int committed = heard.committed_views();
  if (stop.views > committed) throw ahead(committed, fmt::format("an end after {}", stop.views));
  if (stop.views < committed) {
    throw RejectedMessage(fmt::format("nobody decided it: it is of {} views, and {} are committed",
                                      stop.views, committed));
  }
  check_no_goal_under_way(stop.views + 1, heard);
}

void check_follows(const timing_t& timing, const RunRecord& heard) {
  constexpr std::array<std::string_view, 7> kNames = {"move", "scan",        "update",     "digest",
                                                      "plan", "fold_before", "wait_before"};
  check_fits_run(config_of(heard), timing.view - 1, timing.attempt);
  if (timing.view > heard.latest_view() + 1) {
    throw RejectedMessage(fmt::format("view {} is far ahead of the run", timing.view));
  }
  for (const std::string_view name : names_of(timing.duration_names)) {
    if (std::ranges::find(kNames, name) == kNames.end()) throw NotNow();
  }
}

}  // namespace nextview
