#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "lcmtypes/validate.h"
#include "lcmtypes/validate_checks.h"
#include "planner/strategy_facts.h"
#include "sensor/sensor_geometry.h"

namespace nextview {
namespace {

void check_scene(Checks& checks, const run_config_t& config) {
  if (config.scene.unit_m != 0.0) checks.within(bounds::kUnit, config.scene.unit_m);
  checks.within(bounds::kPosition, config.scene.origin_in_file_m);
  checks.within("has_scene", config.has_scene, 0, 1);
  if (config.has_scene == 0) {
    checks.require(config.scene_file.empty() && config.scene_digest.empty(),
                   "a scene_file or scene_digest without a scene");
    return;
  }
  checks.require(!config.scene_file.empty(), "no scene_file");
  checks.require(config.scene_up.empty() || config.scene_up == "x" || config.scene_up == "y" ||
                     config.scene_up == "z",
                 "scene_up is none of x, y, z and not empty");
  checks.digest("scene_digest", config.scene_digest);
}

/// Whether there can be a sensor of this geometry.
void check_geometry(Checks& checks, const sensor_config_t& sensor) {
  SensorParameters parameters;
  std::ranges::copy(sensor.geometry_parameter, parameters.begin());
  try {
    nextview::check_sensor(make_sensor(static_cast<SensorKind>(sensor.geometry), sensor.columns,
                                       sensor.rows, parameters));
  } catch (const std::invalid_argument& error) {
    checks.require(false, error.what());
  }
}

void check_sensor(Checks& checks, const sensor_config_t& sensor) {
  checks.require(sensor.geometry >= 0 && sensor.geometry < kSensorKinds,
                 fmt::format("geometry {} is not 0, 1 or 2: tilted line scan, spherical, line "
                             "striper",
                             sensor.geometry));
  checks.within(bounds::kColumns, sensor.columns);
  checks.within(bounds::kRows, sensor.rows);
  if (checks.reason().empty()) check_geometry(checks, sensor);
  checks.within(bounds::kRangeMin, sensor.range_min_m);
  checks.within(bounds::kRangeMax, sensor.range_max_m);
  checks.below("range_min_m", sensor.range_min_m, "range_max_m", sensor.range_max_m);
  checks.within(bounds::kRangeNoise, sensor.range_noise_m);
  checks.within(bounds::kScanDuration, sensor.scan_duration_s);
}

void check_base(Checks& checks, const base_config_t& base) {
  checks.within(bounds::kPosition, base.start_m);
  checks.within(bounds::kPan.as("start_pan_rad"), base.start_pan_rad);
  checks.within(bounds::kTilt.as("start_tilt_rad"), base.start_tilt_rad);
  checks.within(bounds::kBodyRadius, base.body_radius_m);
  checks.within(bounds::kWorkspace, base.workspace_min_m);
  checks.within(bounds::kWorkspace, base.workspace_max_m);
  for (int axis = 0; axis < 3; ++axis) {
    checks.below("workspace_min_m", base.workspace_min_m[axis], "workspace_max_m",
                 base.workspace_max_m[axis]);
  }
  checks.within(bounds::kLift, base.lift_min_m);
  checks.within(bounds::kLift, base.lift_max_m);
  checks.below("lift_min_m", base.lift_min_m, "lift_max_m", base.lift_max_m);
  checks.within(bounds::kBaseSpeed, base.base_speed_m_s);
  checks.within(bounds::kLiftSpeed, base.lift_speed_m_s);
  checks.within(bounds::kTurnSpeed, base.turn_speed_rad_s);
}

void check_map(Checks& checks, const map_config_t& map) {
  checks.within(bounds::kVoxelSize, map.voxel_size_m);
  checks.within(bounds::kPosition, map.map_origin_m);
  for (int axis = 0; axis < 3; ++axis) {
    checks.within(bounds::kWindowSize, map.window_size[axis]);
    checks.within(bounds::kWindowMin, map.window_min[axis]);
  }
}

void check_planner(Checks& checks, const planner_config_t& planner) {
  checks.within(bounds::kMaxViews, planner.max_views);
  checks.within(bounds::kMaxAttempts, planner.max_attempts);
  checks.require(planner.quality_weight == 0.0 || planner.quality_weight == 1.0,
                 "quality_weight is neither 0 nor 1");
  checks.require(planner.stop_rule >= 1 && planner.stop_rule <= 3, "stop_rule is not 1, 2 or 3");
  if (planner.prediction_columns != 0 || planner.prediction_rows != 0) {
    checks.within(bounds::kPredictionRays, planner.prediction_columns);
    checks.within(bounds::kPredictionRays, planner.prediction_rows);
  }
  checks.within(bounds::kFactorWeight, planner.structure_weight);
  checks.within(bounds::kFactorWeight, planner.navigation_weight);
  checks.within(bounds::kPathCost, planner.path_cost_per_m);
  checks.within(bounds::kDeparture.as("later_departure_m"), planner.later_departure_m);
  checks.within(bounds::kLeastOverlap, planner.least_overlap);
  if (planner.least_gain_m2 != 0.0) checks.within(bounds::kLeastGain, planner.least_gain_m2);
  checks.within("return_home", planner.return_home, 0, 1);
  checks.within(bounds::kQualityThreshold, planner.quality_threshold);
  checks.within(bounds::kClearance, planner.clearance_m);
  checks.within(bounds::kDeparture, planner.departure_m);
  checks.require(
      std::ranges::find(bounds::kDirections, planner.directions) != bounds::kDirections.end(),
      fmt::format("directions = {} is none of {}", planner.directions,
                  fmt::join(bounds::kDirections, ", ")));
  checks.within(bounds::kThreads, planner.threads);
  checks.within(bounds::kStep, planner.step_min_m);
  checks.within(bounds::kStep, planner.step_max_m);
  checks.require(planner.step_min_m <= planner.step_max_m, "step_min_m is above step_max_m");
  checks.within(bounds::kFitnessTolerance, planner.fitness_tolerance);
  checks.within(bounds::kMaxEvaluations, planner.max_evaluations);
  checks.within(bounds::kStopWindow, planner.stop_window_views);
  checks.within(bounds::kStopNewArea, planner.stop_new_area_m2);
}

}  // namespace

std::string check(const run_config_t& config) {
  Checks checks;
  checks.require(config.utime == 0, "utime is not 0");
  check_scene(checks, config);
  check_sensor(checks, config.sensor);
  check_base(checks, config.base);
  check_map(checks, config.map);
  check_planner(checks, config.planner);
  const StrategyFacts* strategy = find_strategy(config.strategy);
  checks.require(strategy != nullptr, no_such_strategy(config.strategy));
  if (strategy != nullptr && strategy->ends_by_least_gain) {
    checks.within(bounds::kLeastGain, config.planner.least_gain_m2);
  }
  // The objective of such a strategy has no such factors: what is asked for must not be ignored.
  checks.require(
      strategy == nullptr || strategy->weighs_factors ||
          (config.planner.structure_weight == 0.0 && config.planner.navigation_weight == 0.0),
      "a structure_weight or navigation_weight with the strategy " + config.strategy);
  return checks.reason();
}

}  // namespace nextview
