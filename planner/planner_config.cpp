#include "planner/planner_config.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "mapper/mapper_config.h"
#include "planner/paper_strategy.h"
#include "planner/prediction/fast_view_predictor.h"
#include "planner/prediction/orientations.h"
#include "planner/prediction/panorama_view_predictor.h"
#include "planner/surface_strategy.h"
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
  if (config.strategy != PaperStrategy::kName) return {};
  FactorWeights weights = {};
  weights[kQualityFactor] = config.planner.quality_weight;
  weights[kStructureFactor] = config.planner.structure_weight;
  weights[kNavigationFactor] = config.planner.navigation_weight;
  return weights;
}

namespace {

PlannerParameters planner_parameters_of(const run_config_t& config) {
  PlannerParameters parameters;
  parameters.weights = factor_weights_of(config);
  parameters.step_min_m = config.planner.step_min_m;
  parameters.step_max_m = config.planner.step_max_m;
  parameters.fitness_tolerance = config.planner.fitness_tolerance;
  parameters.max_evaluations = config.planner.max_evaluations;
  parameters.feasibility = feasibility_of(config);
  return parameters;
}

StopParameters stop_parameters_of(const run_config_t& config) {
  return {.use_quality = config.planner.stop_rule == 2,
          .quality_threshold = config.planner.quality_threshold,
          .stop_window_views = config.planner.stop_window_views,
          .stop_new_area_m2 = config.planner.stop_new_area_m2};
}

std::vector<Orientation> orientations_of(const run_config_t& config) {
  int subdivisions = 0;
  for (int faces = 20; faces < config.planner.directions; faces *= 4) ++subdivisions;
  return icosahedron_orientations(subdivisions);
}

PredictionRaster raster_of(const run_config_t& config) {
  PredictionRays rays;
  if (config.planner.prediction_columns > 0) {
    rays = {config.planner.prediction_columns, config.planner.prediction_rows};
  }
  return prediction_raster(sensor_of(config), range_limits_of(config), rays);
}

/// Every ray of every orientation, or with more than 20 orientations one panorama that answers them
/// all.
std::unique_ptr<ViewPredictor> make_predictor(const run_config_t& config) {
  const PredictionRaster raster = raster_of(config);
  const bool counts_surfaces = ask_for_surfaces(factor_weights_of(config));
  if (config.planner.directions > 20) {
    return std::make_unique<PanoramaViewPredictor>(raster, config.map.voxel_size_m,
                                                   orientations_of(config), counts_surfaces,
                                                   config.planner.threads);
  }
  return std::make_unique<FastViewPredictor>(raster, config.map.voxel_size_m,
                                             orientations_of(config), counts_surfaces,
                                             config.planner.threads);
}

/// A sixteenth of the rays.
std::unique_ptr<ViewPredictor> make_coarse_predictor(const run_config_t& config) {
  const PredictionRaster fine = raster_of(config);
  const PredictionRays coarse{std::max(8, fine.rays.columns() / 4),
                              std::max(4, fine.rays.rows() / 4)};
  return std::make_unique<FastViewPredictor>(
      prediction_raster(sensor_of(config), range_limits_of(config), coarse),
      config.map.voxel_size_m, orientations_of(config), false, config.planner.threads);
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

std::unique_ptr<Strategy> make_strategy(const run_config_t& config) {
  if (config.strategy == PaperStrategy::kName) {
    return std::make_unique<PaperStrategy>(planner_parameters_of(config),
                                           stop_parameters_of(config), config.map.voxel_size_m,
                                           make_predictor(config), make_coarse_predictor(config));
  }
  if (config.strategy == SurfaceStrategy::kName) {
    return std::make_unique<SurfaceStrategy>(raster_of(config), config.map.voxel_size_m,
                                             orientations_of(config),
                                             surface_parameters_of(config));
  }
  throw std::invalid_argument("there is no strategy '" + config.strategy + "'");
}

}  // namespace

std::unique_ptr<ViewPlanner> make_view_planner(const run_config_t& config) {
  return std::make_unique<ViewPlanner>(
      grid_of(config), window_of(config), make_strategy(config),
      ViewPlanner::Parameters{.seed = config.seed,
                              .max_views = config.planner.max_views,
                              .threads = config.planner.threads});
}

}  // namespace nextview
