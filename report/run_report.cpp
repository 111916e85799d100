#include "report/run_report.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>

#include "report/median.h"

namespace nextview {
namespace {

constexpr double kDegreesPerRad = 180.0 / std::numbers::pi;

template <class... Values>
std::string format(const char* pattern, Values... values) {
  const int size = std::snprintf(nullptr, 0, pattern, values...);
  std::string text(static_cast<std::size_t>(size), '\0');
  std::snprintf(text.data(), text.size() + 1, pattern, values...);
  return text;
}

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

double path_length_m(const FinishedRun& run) {
  double length_m = 0.0;
  for (const ViewRow& row : run.rows) length_m += row.arrival.path_length_m;
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
  return duration ? format("%.6f", *duration) : std::string();
}

/// The value of one of a goal's factors; 0 of one it does not have.
double factor_of(const goal_t& goal, std::string_view name) {
  const std::vector<std::string_view> names = names_of(goal.factor_names);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return 0.0;
  return goal.factor_value[static_cast<std::size_t>(found - names.begin())];
}

std::string coverage_text(const ViewRow& row) {
  return row.surface_coverage ? format("%.6f", *row.surface_coverage) : std::string();
}

std::string decision_text(const ViewRow& row) {
  if (!row.chosen()) return ",,,";
  return format("%.9g,%d,%d,", row.goal.fitness, row.goal.iterations, row.goal.evaluations) +
         seconds_text(row.plan_s);
}

}  // namespace

ArtefactFiles::ArtefactFiles(const std::filesystem::path& folder)
    : log(folder / "run.lcmlog"), views(folder / "views.csv"), summary(folder / "summary.json") {}

void write_views(std::ostream& out, const FinishedRun& run) {
  out << "view,x_m,y_m,z_m,pan_deg,tilt_deg,fitness,iterations,evaluations,plan_s,mean_quality,"
         "occupied_area_m2,occlusion_plane_area_m2,surface_coverage,map_digest,"
         "attempt,path_length_m,simulated_s,min_quality,share_occupied,share_occlusion_plane,"
         "share_unseen,share_open,quality_factor,"
         "move_s,scan_s,update_s,digest_s,fold_s,wait_s\n";
  for (const ViewRow& row : run.rows) {
    const commit_t& commit = row.commit;
    out << row.view << ','
        << format("%.6f,%.6f,%.6f,%.4f,%.4f,", commit.used_position_m[0], commit.used_position_m[1],
                  commit.used_position_m[2], commit.pan_rad * kDegreesPerRad,
                  commit.tilt_rad * kDegreesPerRad)
        << decision_text(row) << ','
        << format("%.6f,%.4f,%.4f,", commit.mean_quality, commit.occupied_area_m2,
                  commit.occlusion_plane_area_m2)
        << coverage_text(row) << ',' << commit.map_digest << ','
        << format("%d,%.6f,%.6f,%.6f,", row.goal.attempt, row.arrival.path_length_m,
                  static_cast<double>(commit.utime) * 1e-6, commit.min_quality);
    if (row.chosen()) {
      out << format("%.6f,%.6f,%.6f,%.6f,%.6f,", row.goal.share_occupied,
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
    out << '\n';
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
  json["messages"] = Json::object();
  for (const auto& [role, status] : run.statuses) {
    json["messages"][role] = {{"lost", status.lost},
                              {"repeated", status.repeated},
                              {"foreign", status.foreign},
                              {"refused", status.refused}};
  }
  json["log"] = {{"messages", run.log.messages},
                 {"duplicates", run.log.duplicates},
                 {"strangers", run.log.strangers}};
  if (run.visible) {
    json["visible_surface"] = {{"area_m2", run.visible->area_m2()},
                               {"samples", run.visible->points_m.size()},
                               {"samples_of_scene", run.visible->samples},
                               {"samples_per_m2", run.visible->samples_per_m2},
                               {"positions", run.visible->positions}};
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
    out << format("  %-22s", name) << value << '\n';
  };
  out << run.config.scene_name << ", seed " << run.config.seed << ": " << run.rows.size()
      << " views, " << run.stop_reason << ". " << run.stop_detail << '\n';
  if (run.rows.empty()) return;
  const ViewRow& last = run.rows.back();
  if (last.surface_coverage) {
    line("surface coverage", format("%.3f of %.1f m2 that can be seen", *last.surface_coverage,
                                    run.visible ? run.visible->area_m2() : 0.0));
  } else {
    line("surface coverage", "unknown, because " + run.coverage_unknown);
  }
  line("mean quality", format("%.3f", last.commit.mean_quality));
  line("occupied area", format("%.1f m2", last.commit.occupied_area_m2));
  line("path, collisions", format("%.1f m, %d", path_length_m(run), run.collisions));
  if (run.other_refusals > 0) line("other refusals", std::to_string(run.other_refusals));
  std::string medians;
  for (const Stage& stage : kStages) {
    medians +=
        format("%s%s %.2f", medians.empty() ? "" : ", ", stage.name, 1e3 * median_s(run, stage));
  }
  line("medians, ms", medians);
  line("wall time",
       format("%.2f s; first goal to last commit %.2f s, %.0f %% of it bus and waiting", run.wall_s,
              run.first_goal_to_last_commit_s, 100.0 * bus_and_waiting_share(run)));
  line("map digest", last.commit.map_digest);
}

}  // namespace nextview
