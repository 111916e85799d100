#include "logger/replay.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "lcmtypes/decode.h"
#include "planner/goal_message.h"
#include "planner/planner_config.h"

namespace nextview {
namespace {

std::string of_view(int view) { return "view " + std::to_string(view); }

/// Which part of a goal differs; empty when all of it is the same, bit for bit.
std::string difference(const goal_t& logged, goal_t decided) {
  decided.utime = logged.utime;
  decided.run = logged.run;
  decided.view = logged.view;
  decided.attempt = logged.attempt;
  if (encode(logged) == encode(decided)) return {};
  const bool same_pose = std::equal(logged.position_m, logged.position_m + 3, decided.position_m) &&
                         logged.pan_rad == decided.pan_rad && logged.tilt_rad == decided.tilt_rad;
  if (!same_pose) return "its pose";
  if (logged.waypoint_m != decided.waypoint_m) return "its path";
  if (logged.fitness != decided.fitness) return "its fitness";
  if (logged.iterations != decided.iterations || logged.evaluations != decided.evaluations) {
    return "the length of its search";
  }
  return "the shares its fitness is made of";
}

bool same_search(const search_t& logged, search_t decided) {
  decided.utime = logged.utime;
  decided.run = logged.run;
  decided.view = logged.view;
  decided.attempt = logged.attempt;
  return encode(logged) == encode(decided);
}

/// Decides all attempts of a view again, on the map as it was: false, and why in the report, when
/// one differs.
bool decide_view(const RunRecord& record, ViewPlanner& planner, int view, int attempts,
                 ReplayReport& report) {
  const auto disagree = [&](int attempt, const std::string& how) {
    report.disagreement =
        of_view(view) + ": the goal of attempt " + std::to_string(attempt) + " " + how;
    return false;
  };
  for (int attempt = 1; attempt <= attempts; ++attempt) {
    if (attempt > 1) planner.refuse();
    const goal_t* goal = record.goal(view, attempt);
    const NextView& next = planner.next_view();
    const auto* decision = std::get_if<Decision>(&next);
    if (!decision || !goal) {
      if (!decision && !goal && record.ends_without_goal()) return true;
      return disagree(attempt, decision ? "is not in the log" : "is found no more");
    }
    const std::string what = difference(*goal, goal_message(*decision));
    if (!what.empty()) return disagree(attempt, "differs in " + what);
    const search_t* search = record.search(view, attempt);
    if (!search || !same_search(*search, search_message(*decision))) {
      return disagree(attempt, "differs in what was tried on the way to it");
    }
    ++report.goals;
  }
  return true;
}

/// What keeps a log from being replayed at all.
std::string unfit(const RunLog& log) {
  const RunRecord& record = log.record();
  if (!record.config()) return "no run's configuration is in the log";
  if (!log.contradictions().empty()) return log.contradictions().front();
  if (record.commits().empty()) return "no view is in the log";
  return {};
}

}  // namespace

ReplayReport replay(const RunLog& log, const ReplayOptions& options) {
  ReplayReport report;
  report.disagreement = unfit(log);
  if (!report.disagreement.empty()) return report;
  const RunRecord& record = log.record();
  if (record.stop()) report.stop_reason = record.stop()->stop_reason;
  const int views = record.stop() ? record.stop()->views : record.latest_view();

  const std::unique_ptr<ViewPlanner> planner = make_view_planner(*record.config());
  std::string history;
  for (int view = 1; view <= views; ++view) {
    const auto missing = record.missing_of_view(view);
    if (!missing.empty()) {
      report.disagreement = of_view(view) + ": the log lacks " + describe(missing.front());
      return report;
    }
    const commit_t& commit = *record.commit(view);
    if (options.planner && view > 1 &&
        !decide_view(record, *planner, view, commit.attempt, report)) {
      return report;
    }
    const ReceivedRangeImage& received = *record.range_image(view, commit.attempt);
    planner->fold(received.image);
    const std::string digest = planner->builder().digest();
    if (digest != commit.map_digest) {
      report.disagreement = of_view(view) + ": the map rebuilt has digest " + digest +
                            ", the one committed had " + commit.map_digest;
      return report;
    }
    history = history_digest(history, received);
    if (history != commit.history_digest) {
      report.disagreement = of_view(view) + ": the range images so far have history digest " +
                            history + ", the commit says " + commit.history_digest;
      return report;
    }
    ++report.views;
  }
  if (!record.stop()) {
    report.disagreement = of_view(views + 1) + ": the log breaks off, it holds no end of the run";
    return report;
  }
  if (options.planner && record.ends_without_goal()) {
    decide_view(record, *planner, views + 1, record.stop()->final_attempt, report);
  }
  return report;
}

}  // namespace nextview
