#include "logger/replay.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "lcmtypes/decode.h"
#include "mapper/map_builder.h"
#include "mapper/mapper_config.h"
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
  decided.plan_wall_s = logged.plan_wall_s;
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
  decided.fold_wall_s = logged.fold_wall_s;
  decided.wait_wall_s = logged.wait_wall_s;
  return encode(logged) == encode(decided);
}

/// Decides again, on the map as it was.
class PlannerReplay {
 public:
  PlannerReplay(const RunRecord& record, ReplayReport& report)
      : record_(record),
        report_(report),
        parameters_(planner_parameters_of(*record.config())),
        predictor_(make_predictor(*record.config())) {}

  void map_changed(const VoxelMap& map, const FoldReport& fold) {
    predictor_->map_changed(map, fold.changed_slots, fold.updated_surfaces);
  }

  /// All attempts of a view: false, and why in the report, when one differs.
  bool decide_view(const VoxelMap& map, const SensorPose& present, int view, int attempts) {
    std::vector<SensorPose> refused;
    for (int attempt = 1; attempt <= attempts; ++attempt) {
      const goal_t* goal = record_.goal(view, attempt);
      const std::optional<Decision> decision = decide_next_view(
          map, *predictor_, parameters_, present, record_.config()->seed, view, attempt, refused);
      if (!decision || !goal) {
        if (!decision && !goal && record_.ends_without_goal()) return true;
        return disagree(view, attempt, decision ? "is not in the log" : "is found no more");
      }
      const std::string what = difference(*goal, goal_message(*decision));
      if (!what.empty()) return disagree(view, attempt, "differs in " + what);
      const search_t* search = record_.search(view, attempt);
      if (!search || !same_search(*search, search_message(*decision))) {
        return disagree(view, attempt, "differs in what was tried on the way to it");
      }
      refused.push_back(decision->pose);
      ++report_.goals;
    }
    return true;
  }

 private:
  bool disagree(int view, int attempt, const std::string& how) {
    report_.disagreement =
        of_view(view) + ": the goal of attempt " + std::to_string(attempt) + " " + how;
    return false;
  }

  const RunRecord& record_;
  ReplayReport& report_;
  PlannerParameters parameters_;
  std::unique_ptr<ViewPredictor> predictor_;
};

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
  const run_config_t& config = *record.config();
  if (record.stop()) report.stop_reason = record.stop()->stop_reason;
  const int views = record.stop() ? record.stop()->views : record.latest_view();

  MapBuilder builder(grid_of(config), window_of(config));
  std::optional<PlannerReplay> planner;
  if (options.planner) planner.emplace(record, report);
  SensorPose present;
  for (int view = 1; view <= views; ++view) {
    const auto missing = record.missing_of_view(view);
    if (!missing.empty()) {
      report.disagreement = of_view(view) + ": the log lacks " + describe(missing.front());
      return report;
    }
    const commit_t& commit = *record.commit(view);
    if (planner && view > 1 &&
        !planner->decide_view(builder.map(), present, view, commit.attempt)) {
      return report;
    }
    const RangeImage& image = record.range_image(view, commit.attempt)->received.image;
    const FoldReport& fold = builder.fold(image);
    if (planner) planner->map_changed(builder.map(), fold);
    present = image.pose;
    const std::string digest = builder.digest();
    if (digest != commit.map_digest) {
      report.disagreement = of_view(view) + ": the map rebuilt has digest " + digest +
                            ", the one committed had " + commit.map_digest;
      return report;
    }
    ++report.views;
  }
  if (!record.stop()) {
    report.disagreement = of_view(views + 1) + ": the log breaks off, it holds no end of the run";
    return report;
  }
  if (planner && record.ends_without_goal()) {
    planner->decide_view(builder.map(), present, views + 1, record.stop()->final_attempt);
  }
  return report;
}

}  // namespace nextview
