#include "planner/planner_config.h"

#include <algorithm>
#include <vector>

#include "mapper/mapper_config.h"
#include "planner/paper_strategy.h"
#include "planner/strategy_inputs.h"
#include "sensor/sensor_config.h"

namespace nextview {

FeasibilityParameters feasibility_of(const run_config_t& config) {
  return {.clearance_m = config.planner.clearance_m,
          .body_radius_m = config.base.body_radius_m,
          .departure_m = config.planner.departure_m,
          .workspace_min_m = Eigen::Vector3d(config.base.workspace_min_m),
          .workspace_max_m = Eigen::Vector3d(config.base.workspace_max_m),
          .lift_min_m = config.base.lift_min_m,
          .lift_max_m = config.base.lift_max_m};
}

FactorWeights factor_weights_of(const run_config_t& config) {
  const StrategyFacts* strategy = find_strategy(config.strategy);
  if (strategy == nullptr || !strategy->weighs_factors) return {};
  FactorWeights weights = {};
  weights[kQualityFactor] = config.planner.quality_weight;
  weights[kStructureFactor] = config.planner.structure_weight;
  weights[kNavigationFactor] = config.planner.navigation_weight;
  return weights;
}

namespace {

/// The paper's method goes by one departure for all moves (README, the body rule). Among more than
/// its 20 directions, or after computed views, what is hidden is looked into from ever nearer to
/// it.
double later_departure_of_simplex_m(const run_config_t& config) {
  const StrategyFacts* strategy = find_strategy(config.strategy);
  const bool alike = strategy != nullptr && strategy->departs_alike &&
                     config.planner.directions == strategy->directions;
  return alike ? config.planner.departure_m : config.planner.later_departure_m;
}

PlannerParameters planner_parameters_of(const run_config_t& config) {
  PlannerParameters parameters;
  parameters.weights = factor_weights_of(config);
  parameters.step_min_m = config.planner.step_min_m;
  parameters.step_max_m = config.planner.step_max_m;
  parameters.fitness_tolerance = config.planner.fitness_tolerance;
  parameters.max_evaluations = config.planner.max_evaluations;
  parameters.feasibility = feasibility_of(config);
  parameters.later_departure_m = later_departure_of_simplex_m(config);
  return parameters;
}

StopParameters stop_parameters_of(const run_config_t& config) {
  return {.rule = StopRule{config.planner.stop_rule},
          .quality_threshold = config.planner.quality_threshold,
          .stop_window_views = config.planner.stop_window_views,
          .stop_new_area_m2 = config.planner.stop_new_area_m2,
          .stop_improvement = StopParameters{}.stop_improvement};
}

int subdivisions_of(const run_config_t& config) {
  int subdivisions = 0;
  for (int faces = 20; faces < config.planner.directions; faces *= 4) ++subdivisions;
  return subdivisions;
}

PredictionRaster raster_of(const run_config_t& config, const PredictionRays& at_most) {
  return prediction_raster(sensor_of(config), range_limits_of(config), at_most);
}

PredictionRaster raster_of(const run_config_t& config) {
  if (config.planner.prediction_columns == 0) return raster_of(config, PredictionRays());
  return raster_of(config, {config.planner.prediction_columns, config.planner.prediction_rows});
}

PredictionRaster coarse_raster_of(const run_config_t& config) {
  const PredictionRaster fine = raster_of(config);
  return raster_of(config,
                   {std::max(8, fine.rays.columns() / 4), std::max(4, fine.rays.rows() / 4)});
}

SurfaceParameters surface_parameters_of(const run_config_t& config) {
  constexpr double kImprovementWeight = 0.3;  // docs/strategy.md
  SurfaceParameters parameters;
  parameters.path_cost_per_m = config.planner.path_cost_per_m;
  parameters.improvement_weight = kImprovementWeight * config.planner.quality_weight;
  parameters.min_overlap = config.planner.least_overlap;
  parameters.least_new_area_m2 = config.planner.least_gain_m2;
  parameters.first_departure_m = config.planner.departure_m;
  parameters.departure_m = config.planner.later_departure_m;
  parameters.return_home = config.planner.return_home != 0;
  parameters.feasibility = feasibility_of(config);
  return parameters;
}

TidyUpParameters tidy_up_parameters_of(const run_config_t& config) {
  TidyUpParameters parameters;
  parameters.view.field = field_of_view(make_ray_table(sensor_of(config)));
  parameters.view.range_min_m = range_limits_of(config).min_m;
  parameters.view.range_max_m = range_limits_of(config).max_m;
  parameters.view.path_cost_per_m = config.planner.path_cost_per_m;
  parameters.feasibility = feasibility_of(config);
  parameters.feasibility.departure_m = config.planner.later_departure_m;
  return parameters;
}

StrategyInputs strategy_inputs_of(const run_config_t& config) {
  return {.voxel_size_m = config.map.voxel_size_m,
          .raster = raster_of(config),
          .coarse_raster = coarse_raster_of(config),
          .subdivisions = subdivisions_of(config),
          .orientations = icosahedron_orientations(subdivisions_of(config)),
          .threads = config.planner.threads,
          .search = planner_parameters_of(config),
          .stop = stop_parameters_of(config),
          .surface = surface_parameters_of(config),
          .tidy_up = tidy_up_parameters_of(config)};
}

}  // namespace

std::unique_ptr<ViewPlanner> make_view_planner(const run_config_t& config) {
  return std::make_unique<ViewPlanner>(
      grid_of(config), window_of(config),
      make_strategy(config.strategy, strategy_inputs_of(config)),
      ViewPlanner::Parameters{.seed = config.seed,
                              .max_views = config.planner.max_views,
                              .threads = config.planner.threads});
}

}  // namespace nextview
