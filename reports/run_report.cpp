#include "reports/run_report.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "planner/goal_message.h"
#include "planner/planner_config.h"
#include "reports/median.h"

namespace nextview {
namespace {

constexpr double kDegreesPerRad = 180.0 / std::numbers::pi;

using Duration = ViewRow::Duration;

/// Where the time of a view goes; fold and wait are the planner's.
struct Stage {
  const char* name;
  Duration ViewRow::*duration;
};
constexpr Stage kStages[] = {{"plan", &ViewRow::plan_s},     {"move", &ViewRow::move_s},
                             {"scan", &ViewRow::scan_s},     {"update", &ViewRow::update_s},
                             {"digest", &ViewRow::digest_s}, {"fold", &ViewRow::fold_s},
                             {"wait", &ViewRow::wait_s}};

/// The median of what is known of a stage.
double median_s(const FinishedRun& run, const Stage& stage) {
  std::vector<double> values;
  for (const ViewRow& row : run.rows) {
    if (const Duration& duration = row.*stage.duration) values.push_back(*duration);
  }
  return median(values);
}

/// Of the way up to a view, or of all.
double path_length_m(const FinishedRun& run, int last_view = std::numeric_limits<int>::max()) {
  double length_m = 0.0;
  for (const ViewRow& row : run.rows) {
    if (row.view <= last_view) length_m += row.arrival.path_length_m;
  }
  return length_m;
}

/// The share of the time from first goal to last commit in which no stage worked that the next
/// goal waits for. It waits for two at once: the mapper's update and digest, and the planner's own
/// fold and decision. The longer one counts. A timing that was lost counts as waiting.
double bus_and_waiting_share(const FinishedRun& run) {
  if (run.first_goal_to_last_commit_s <= 0.0) return 0.0;
  double working_s = 0.0;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const ViewRow& row = run.rows[i];
    const double mapper_s = row.update_s.value_or(0.0) + row.digest_s.value_or(0.0);
    // The time ends with the last commit, whatever the planner does beside it.
    const bool last = i + 1 == run.rows.size();
    const double planner_s =
        last ? 0.0 : row.fold_s.value_or(0.0) + run.rows[i + 1].first_plan_s.value_or(0.0);
    working_s += row.refused_s.value_or(0.0) + row.move_s.value_or(0.0) + row.scan_s.value_or(0.0) +
                 std::max(mapper_s, planner_s);
  }
  return std::max(0.0, 1.0 - working_s / run.first_goal_to_last_commit_s);
}

/// Seconds, or a blank where the timing was lost.
std::string seconds_text(const Duration& duration) {
  return duration ? fmt::format("{:.6f}", *duration) : std::string();
}

/// Those of kFactors that have no column in the contract's order, where quality has: their columns
/// stand at the end.
bool is_at_the_end(const Factor& factor) { return factor.name != "quality"; }

/// The factors at the end, each after a comma; blank where they do not count.
std::string factors_text(const ViewRow& row, const FactorWeights& weights) {
  std::string text;
  for (std::size_t i = 0; i < kFactors.size(); ++i) {
    if (!is_at_the_end(kFactors[i])) continue;
    text += ',';
    if (!row.chosen() || weights[i] == 0.0) continue;
    text += fmt::format("{:.6f}", factor_of(row.goal, kFactors[i].name));
  }
  return text;
}

/// A share, or a blank where it is not known.
std::string share_text(const std::optional<double>& share) {
  return share ? fmt::format("{:.6f}", *share) : std::string();
}

/// The first view after which a share of surface coverage is reached; nothing when none is.
const ViewRow* first_with(const FinishedRun& run, double share) {
  const auto found = std::find_if(run.rows.begin(), run.rows.end(), [share](const ViewRow& row) {
    return row.surface_coverage && *row.surface_coverage >= share;
  });
  return found == run.rows.end() ? nullptr : &*found;
}

nlohmann::ordered_json bounds_json(const FinishedRun& run) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const ViewBound& bound : run.bounds) {
    nlohmann::ordered_json& json = all.emplace_back();
    json["surface_coverage"] = bound.share;
    const ViewRow* row = first_with(run, bound.share);
    json["views"] = row ? nlohmann::ordered_json(row->view) : nullptr;
    json["path_length_m"] = row ? nlohmann::ordered_json(path_length_m(run, row->view)) : nullptr;
    json["can_be_reached"] = bound.reached;
    if (!bound.reached) continue;
    json["greedy_views"] = bound.greedy_views;
    json["greedy_path_length_m"] = bound.greedy_m;
    json["least_views"] = bound.fewest_views;
    json["least_path_length_m"] = bound.shortest_m;
  }
  return all;
}

/// The run against the bound for 95 %, the last line of its table.
std::string bound_text(const FinishedRun& run) {
  constexpr double kShare = 0.95;
  const auto bound = std::find_if(run.bounds.begin(), run.bounds.end(),
                                  [](const ViewBound& each) { return each.share == kShare; });
  if (bound == run.bounds.end()) return "how few views it could be says: " + run.bound_command;
  const ViewRow* row = first_with(run, kShare);
  std::string text = "95 % ";
  if (row) {
    text += fmt::format("in {} views", row->view);
  } else if (run.coverage_unknown.empty()) {
    text += fmt::format("not reached in {} views", run.rows.size());
  } else {
    text += "unknown";
  }
  if (!bound->reached) return text + ", not even with all views from everywhere reachable";
  return text + fmt::format(", greedy who knows the scene {}, no planner can below {}",
                            bound->greedy_views, bound->fewest_views);
}

std::string decision_text(const ViewRow& row) {
  if (!row.chosen()) return ",,,";
  return fmt::format("{:.9g},{},{},{}", row.goal.fitness, row.goal.iterations, row.goal.evaluations,
                     seconds_text(row.plan_s));
}

}  // namespace

ArtefactFiles::ArtefactFiles(const std::filesystem::path& folder)
    : log(folder / "run.lcmlog"), views(folder / "views.csv"), summary(folder / "summary.json") {}

void write_views(std::ostream& out, const FinishedRun& run) {
  out << "view,x_m,y_m,z_m,pan_deg,tilt_deg,fitness,iterations,evaluations,plan_s,mean_quality,"
         "occupied_area_m2,occlusion_plane_area_m2,surface_coverage,map_digest,"
         "attempt,path_length_m,simulated_s,min_quality,share_occupied,share_occlusion_plane,"
         "share_unseen,share_open,quality_factor,"
         "move_s,scan_s,update_s,digest_s,fold_s,wait_s,surface_precision";
  for (const Factor& factor : kFactors) {
    if (is_at_the_end(factor)) fmt::print(out, ",{}_factor", factor.name);
  }
  out << '\n';
  const FactorWeights weights = factor_weights_of(run.config);
  for (const ViewRow& row : run.rows) {
    const commit_t& commit = row.commit;
    fmt::print(out, "{},{:.6f},{:.6f},{:.6f},{:.4f},{:.4f},{},", row.view,
               commit.used_position_m[0], commit.used_position_m[1], commit.used_position_m[2],
               commit.pan_rad * kDegreesPerRad, commit.tilt_rad * kDegreesPerRad,
               decision_text(row));
    fmt::print(out, "{:.6f},{:.4f},{:.4f},{},{},", commit.mean_quality, commit.occupied_area_m2,
               commit.occlusion_plane_area_m2, share_text(row.surface_coverage), commit.map_digest);
    fmt::print(out, "{},{:.6f},{:.6f},{:.6f},", row.goal.attempt, row.arrival.path_length_m,
               static_cast<double>(commit.utime) * 1e-6, commit.min_quality);
    if (row.chosen()) {
      fmt::print(out, "{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},", row.goal.share_occupied,
                 row.goal.share_occlusion_plane, row.goal.share_unseen, row.goal.share_open,
                 factor_of(row.goal, "quality"));
    } else {
      out << ",,,,,";
    }
    out << seconds_text(row.move_s);
    for (const Duration& duration :
         {row.scan_s, row.update_s, row.digest_s, row.fold_s, row.wait_s}) {
      out << ',' << seconds_text(duration);
    }
    out << ',' << share_text(row.surface_precision) << factors_text(row, weights) << '\n';
  }
}

void write_summary(std::ostream& out, const FinishedRun& run) {
  using Json = nlohmann::ordered_json;
  const ViewRow* last = run.rows.empty() ? nullptr : &run.rows.back();
  Json json;
  json["scene"] = run.config.scene_name;
  json["seed"] = run.config.seed;
  json["views"] = run.rows.size();
  json["stop_reason"] = run.stop_reason;
  json["stop_detail"] = run.stop_detail;
  json["surface_coverage"] =
      last && last->surface_coverage ? Json(*last->surface_coverage) : Json(nullptr);
  if (!run.coverage_unknown.empty()) json["surface_coverage_unknown"] = run.coverage_unknown;
  json["surface_precision"] =
      last && last->surface_precision ? Json(*last->surface_precision) : Json(nullptr);
  if (!run.precision_unknown.empty()) json["surface_precision_unknown"] = run.precision_unknown;
  json["mean_quality"] = last ? last->commit.mean_quality : 0.0;
  json["occupied_area_m2"] = last ? last->commit.occupied_area_m2 : 0.0;
  json["occlusion_plane_area_m2"] = last ? last->commit.occlusion_plane_area_m2 : 0.0;
  json["path_length_m"] = path_length_m(run);
  json["collisions"] = run.collisions;
  json["other_refusals"] = run.other_refusals;
  json["simulated_s"] = last ? static_cast<double>(last->commit.utime) * 1e-6 : 0.0;
  json["plan_s_median"] = median_s(run, kStages[0]);
  json["wall_s"] = run.wall_s;
  json["map_digest"] = last ? last->commit.map_digest : "";

  json["start_up_s"] = run.start_up_s;
  json["first_goal_to_last_commit_s"] = run.first_goal_to_last_commit_s;
  json["bus_and_waiting_share"] = bus_and_waiting_share(run);
  for (const Stage& stage : kStages) json["stage_s_median"][stage.name] = median_s(run, stage);
  json["peak_memory_bytes"] = run.peak_memory_bytes;
  json["map_memory_bytes"] = run.map_memory_bytes;
  json["messages"] = Json::object();
  for (const auto& [role, status] : run.statuses) {
    json["messages"][role] = {{"lost", status.lost},
                              {"repeated", status.repeated},
                              {"foreign", status.foreign},
                              {"refused", status.refused}};
  }
  json["log"] = {
      {"messages", run.log.messages}, {"repeated", run.log.repeated}, {"foreign", run.log.foreign}};
  if (run.visible) {
    json["visible_surface"] = {{"area_m2", run.visible->area_m2()},
                               {"samples", run.visible->points_m.size()},
                               {"samples_of_scene", run.visible->samples},
                               {"samples_per_m2", run.visible->samples_per_m2},
                               {"positions", run.visible->positions}};
  }
  json["bounds"] = run.bounds.empty() ? Json(nullptr) : bounds_json(run);
  if (run.bounds.empty() && !run.bound_command.empty()) {
    json["bounds_unknown"] = "they have not been worked out: " + run.bound_command;
  }
  json["scene_file"] = run.config.scene_file;
  json["scene_digest"] = run.config.scene_digest;
  json["scene_origin_in_file_m"] = run.config.scene.origin_in_file_m;
  json["run"] = run.config.run;
  json["lcm_url"] = run.lcm_url;
  json["versions"] = {{"nextview", run.config.program_version},
                      {"compiler", NEXTVIEW_COMPILER},
                      {"lcm", NEXTVIEW_LCM_VERSION}};
  // A file's name may be any bytes; those that are no UTF-8 become U+FFFD.
  out << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
}

void write_table(std::ostream& out, const FinishedRun& run) {
  const auto line = [&out](const char* name, const std::string& value) {
    fmt::print(out, "  {:<22}{}\n", name, value);
  };
  fmt::print(out, "{}, seed {}: {} views, {}. {}\n", run.config.scene_name, run.config.seed,
             run.rows.size(), run.stop_reason, run.stop_detail);
  if (run.rows.empty()) return;
  const ViewRow& last = run.rows.back();
  if (last.surface_coverage) {
    line("surface coverage",
         fmt::format("{:.3f} of {:.1f} m2 that can be seen", *last.surface_coverage,
                     run.visible ? run.visible->area_m2() : 0.0));
  } else {
    line("surface coverage", "unknown, because " + run.coverage_unknown);
  }
  line("surface precision",
       last.surface_precision
           ? fmt::format("{:.3f} of Occupied voxels with surface in or beside them",
                         *last.surface_precision)
           : "unknown, because " + run.precision_unknown);
  line("mean quality", fmt::format("{:.3f}", last.commit.mean_quality));
  line("occupied area", fmt::format("{:.1f} m2", last.commit.occupied_area_m2));
  line("path, collisions", fmt::format("{:.1f} m, {}", path_length_m(run), run.collisions));
  if (run.other_refusals > 0) line("other refusals", std::to_string(run.other_refusals));
  std::string medians;
  for (const Stage& stage : kStages) {
    medians += fmt::format("{}{} {:.2f}", medians.empty() ? "" : ", ", stage.name,
                           1e3 * median_s(run, stage));
  }
  line("medians, ms", medians);
  line(
      "wall time",
      fmt::format("{:.2f} s; first goal to last commit {:.2f} s, {:.0f} % of it bus and waiting",
                  run.wall_s, run.first_goal_to_last_commit_s, 100.0 * bus_and_waiting_share(run)));
  line("map digest", last.commit.map_digest);
  if (!run.bounds.empty() || !run.bound_command.empty()) out << "  " << bound_text(run) << '\n';
}

}  // namespace nextview
