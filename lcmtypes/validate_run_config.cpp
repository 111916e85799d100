#include <algorithm>
#include <cstdint>
#include <numbers>
#include <string>

#include "lcmtypes/validate.h"
#include "lcmtypes/validate_checks.h"

namespace nextview {
namespace {

void check_scene(Checks& checks, const run_config_t& config) {
  checks.not_negative("unit_m", config.unit_m);  // 0: as the file says
  checks.finite("start_m", config.start_m);
  checks.within("start_pan_rad", config.start_pan_rad, -2.0 * std::numbers::pi,
                2.0 * std::numbers::pi);
  checks.within("start_tilt_rad", config.start_tilt_rad, -std::numbers::pi / 2.0,
                std::numbers::pi / 2.0);
  checks.require(!config.scene_file.empty(), "no scene_file");
  checks.require(config.scene_up.empty() || config.scene_up == "x" || config.scene_up == "y" ||
                     config.scene_up == "z",
                 "scene_up is none of x, y, z and not empty");
  checks.digest("scene_digest", config.scene_digest);
}

void check_sensor(Checks& checks, const run_config_t& config) {
  checks.within("columns", config.columns, 2, kMaxColumnsAndRows);
  checks.within("rows", config.rows, 2, kMaxColumnsAndRows);
  checks.require(std::int64_t{config.columns} + config.rows <= kMaxColumnsAndRows,
                 "raster of " + std::to_string(config.columns) + " x " +
                     std::to_string(config.rows) + " is too large");
  checks.positive("horizontal_aperture_rad", config.horizontal_aperture_rad);
  checks.positive("vertical_aperture_rad", config.vertical_aperture_rad);
  checks.require(
      std::max(config.horizontal_aperture_rad, config.vertical_aperture_rad) < std::numbers::pi,
      "an aperture of 180 degrees or more");
  checks.not_negative("range_min_m", config.range_min_m);
  checks.positive("range_max_m", config.range_max_m);
  checks.require(config.range_min_m < config.range_max_m, "range_min_m is not below range_max_m");
  checks.not_negative("range_noise_m", config.range_noise_m);
  checks.within("scan_duration_s", config.scan_duration_s, 0.0, 1e6);
}

void check_base(Checks& checks, const run_config_t& config) {
  checks.not_negative("body_radius_m", config.body_radius_m);
  checks.finite("workspace_min_m", config.workspace_min_m);
  checks.finite("workspace_max_m", config.workspace_max_m);
  for (int axis = 0; axis < 3; ++axis) {
    checks.require(config.workspace_min_m[axis] < config.workspace_max_m[axis],
                   "workspace_min_m is not below workspace_max_m");
  }
  checks.finite("lift_min_m", config.lift_min_m);
  checks.finite("lift_max_m", config.lift_max_m);
  checks.require(config.lift_min_m <= config.lift_max_m, "lift_min_m is above lift_max_m");
  checks.positive("base_speed_m_s", config.base_speed_m_s);
  checks.positive("lift_speed_m_s", config.lift_speed_m_s);
  checks.positive("turn_speed_rad_s", config.turn_speed_rad_s);
}

void check_map(Checks& checks, const run_config_t& config) {
  checks.positive("voxel_size_m", config.voxel_size_m);
  checks.finite("map_origin_m", config.map_origin_m);
  for (int axis = 0; axis < 3; ++axis) {
    checks.within("window_size", config.window_size[axis], 1, 4096);
    checks.within("window_min", config.window_min[axis], -1e9, 1e9);
  }
}

void check_planner(Checks& checks, const run_config_t& config) {
  checks.within("max_views", config.max_views, 1, 1e6);
  checks.within("max_attempts", config.max_attempts, 1, 1e6);
  checks.within("use_quality", config.use_quality, 0, 1);
  checks.within("quality_threshold", config.quality_threshold, 0.0, 1.0);
  checks.not_negative("clearance_m", config.clearance_m);
  checks.not_negative("departure_m", config.departure_m);
  checks.require(config.directions == 20 || config.directions == 80 || config.directions == 320 ||
                     config.directions == 1280,
                 "directions is not 20, 80, 320 or 1280");
  checks.within("threads", config.threads, 1, 256);
  checks.positive("step_min_m", config.step_min_m);
  checks.positive("step_max_m", config.step_max_m);
  checks.require(config.step_min_m <= config.step_max_m, "step_min_m is above step_max_m");
  checks.not_negative("fitness_tolerance", config.fitness_tolerance);
  // What was tried for one goal has to fit in one search_t.
  checks.within("max_evaluations", config.max_evaluations, 4, 1200);
  checks.within("stop_window_views", config.stop_window_views, 1, 1e6);
  checks.not_negative("stop_new_area_m2", config.stop_new_area_m2);
}

}  // namespace

std::string check(const run_config_t& config) {
  Checks checks;
  checks.require(config.utime == 0, "utime is not 0");
  check_scene(checks, config);
  check_sensor(checks, config);
  check_base(checks, config);
  check_map(checks, config);
  check_planner(checks, config);
  return checks.reason();
}

}  // namespace nextview
