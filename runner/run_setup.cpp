#include "runner/run_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <utility>

#include "base_sim/base_sim_process.h"
#include "lcmtypes/parameter_bounds.h"
#include "lcmtypes/program_version.h"
#include "lcmtypes/validate.h"
#include "mapper/mapper_config.h"
#include "scene/enclosure.h"
#include "scene/scene_catalog.h"
#include "scene/standing_places.h"
#include "sensor/sensor_config.h"

namespace nextview {
namespace {

constexpr double kRadPerDegree = std::numbers::pi / 180.0;

SceneOptions given_options(const RunOptions& options) {
  SceneOptions given;
  try {
    if (options.unit) given.unit_m = parse_unit_m(*options.unit);
  } catch (const std::invalid_argument& error) {
    throw SetupError("--unit: " + std::string(error.what()));
  }
  try {
    if (options.up) given.up = parse_up_axis(*options.up);
  } catch (const std::invalid_argument& error) {
    throw SetupError("--up: " + std::string(error.what()));
  }
  return given;
}

/// Of a place in the world, as a user would type it: in the frame of the scene's file.
std::string as_option(const Eigen::Vector3d& place_m, const Scene& scene) {
  const Eigen::Vector3d start_m = place_m + scene.mesh().origin_in_file_m;
  return fmt::format("--start {:.2f} {:.2f} {:.2f}", start_m.x(), start_m.y(), start_m.z());
}

/// Where in the world the run is to start: as the command line says, else the scene, both in the
/// file's frame; else nowhere.
/// @throws SetupError naming places that would do
Eigen::Vector3d start_in_scene(const RunOptions& options, const SceneDescription& description,
                               const Scene& scene) {
  const Eigen::Vector3d& origin_m = scene.mesh().origin_in_file_m;
  if (!options.start_m.empty()) return Eigen::Vector3d(options.start_m.data()) - origin_m;
  if (description.start_m && !options.start_auto) return *description.start_m - origin_m;
  constexpr std::size_t kNamed = 3;
  const std::vector<Eigen::Vector3d> places =
      standing_places(scene, {.clearance_m = options.clearance_m}, kNamed);
  if (places.empty()) {
    throw SetupError(
        fmt::format("{}: found no place to start from, 1.2 m above a floor and {:.2f} "
                    "m from everything: see --start X Y Z, --clearance, --unit, --up",
                    description.file.string(), options.clearance_m));
  }
  if (options.start_auto) return places.front();
  std::string named;
  for (const Eigen::Vector3d& place : places) named += as_option(place, scene) + ", ";
  throw SetupError(description.file.string() + " says no start position. These would do: " + named +
                   "and --start auto takes the first");
}

void fill_start(run_config_t& config, const RunOptions& options, const SceneDescription& scene,
                const Eigen::Vector3d& start_m) {
  for (int axis = 0; axis < 3; ++axis) config.base.start_m[axis] = start_m[axis];
  config.base.start_pan_rad = scene.start_pan_rad.value_or(0.0);
  if (options.start_pan_deg) config.base.start_pan_rad = *options.start_pan_deg * kRadPerDegree;
  config.base.start_tilt_rad = options.start_tilt_deg * kRadPerDegree;
}

/// The options of which a sensor is made, as typed.
std::string sensor_options_typed(const RunOptions& options) {
  const SensorOptions& given = options.given_of_sensor;
  std::string typed = "--sensor";
  if (options.aperture_deg) typed += ", --aperture";
  if (given.range_min_m) typed += ", --range-min";
  if (given.range_max_m) typed += ", --range-max";
  return typed;
}

SensorModel sensor_given(const RunOptions& options) {
  SensorOptions given = options.given_of_sensor;
  if (options.aperture_deg) given.aperture_rad = *options.aperture_deg * kRadPerDegree;
  try {
    const bool ours = options.sensors_folder.empty();
    return find_sensor(options.sensor, ours ? NEXTVIEW_SENSORS_FOLDER : options.sensors_folder,
                       given);
  } catch (const SensorError& error) {
    throw SetupError(sensor_options_typed(options) + ": " + error.what());
  }
}

void fill_prediction_rays(planner_config_t& planner, const std::string& given) {
  if (given.empty()) return;
  int columns = 0;
  int rows = 0;
  char beyond = 0;
  const bool read = std::sscanf(given.c_str(), "%dx%d%c", &columns, &rows, &beyond) == 2;
  if (!read || !bounds::kPredictionRays.contain(columns) ||
      !bounds::kPredictionRays.contain(rows)) {
    throw SetupError("--prediction-rays must be like 64x32, both numbers " +
                     bounds::kPredictionRays.range() + ", not '" + given + "'");
  }
  planner.prediction_columns = columns;
  planner.prediction_rows = rows;
}

/// The height of what is straight under the start, where the robot stands; of the scene's lowest
/// point when there is nothing, and of the workspace's when there is no scene.
double floor_under_start_m(const run_config_t& config, const Scene* scene,
                           const Eigen::AlignedBox3d& bounds) {
  const Eigen::Vector3d start_m(config.base.start_m);
  const auto below =
      scene == nullptr ? std::nullopt : scene->first_hit(start_m, -Eigen::Vector3d::UnitZ());
  if (!below) return bounds.min().z();
  // Rays are cast in float: to the tenth of a millimetre, and 0 is not -0.
  return std::round(1e4 * (start_m.z() - double{below->distance_m})) / 1e4 + 0.0;
}

void fill_base(run_config_t& config, const RunOptions& options, const Eigen::AlignedBox3d& bounds,
               double floor_m) {
  constexpr double kReach_m = 2.8;  // of the lift, above the floor
  config.base.body_radius_m = options.body_radius_m;
  for (int axis = 0; axis < 3; ++axis) {
    config.base.workspace_min_m[axis] = bounds.min()[axis];
    config.base.workspace_max_m[axis] = bounds.max()[axis];
  }
  config.base.lift_min_m = options.lift_min_m.value_or(floor_m + options.body_radius_m);
  config.base.lift_max_m = options.lift_max_m.value_or(
      std::min(bounds.max().z() - options.body_radius_m, floor_m + kReach_m));
  if (config.base.lift_min_m >= config.base.lift_max_m) {
    throw SetupError(
        fmt::format("the sensor's lowest height, {:.2f} m, is not below its highest, {:.2f} m: see "
                    "--lift-min, --lift-max, --body-radius and --unit",
                    config.base.lift_min_m, config.base.lift_max_m));
  }
  config.base.base_speed_m_s = options.base_speed_m_s;
  config.base.lift_speed_m_s = options.lift_speed_m_s;
  config.base.turn_speed_rad_s = options.turn_speed_deg_s * kRadPerDegree;
}

void fill_map(run_config_t& config, const RunOptions& options, const Eigen::AlignedBox3d& box) {
  config.map.voxel_size_m = options.voxel_size_m;
  const double sides = box.sizes().maxCoeff() / options.voxel_size_m + 2 * options.margin_voxels;
  if (sides > bounds::kWindowSize.most - 2.0) {
    throw SetupError(
        fmt::format("the scene is {:.2f} m long, more than the {} voxels a map may have: give a "
                    "larger --voxel-size, or the right --unit",
                    box.sizes().maxCoeff(), bounds::kWindowSize.most));
  }
  const VoxelGrid grid = grid_of(config);
  const VoxelIndex margin = VoxelIndex::Constant(options.margin_voxels);
  const VoxelIndex min = grid.voxel_of(box.min()) - margin;
  const VoxelIndex max = grid.voxel_of(box.max()) + margin;
  for (int axis = 0; axis < 3; ++axis) {
    config.map.window_min[axis] = min[axis];
    config.map.window_size[axis] = max[axis] - min[axis] + 1;
  }
  try {
    const VoxelMap fits(grid, window_of(config));
  } catch (const std::exception& error) {
    throw SetupError("the map cannot be made: " + std::string(error.what()) +
                     "; give a larger --voxel-size");
  }
}

/// As the command line says, else as the paper has it.
StopRule stop_rule_of(const RunOptions& options, const StrategyFacts& strategy) {
  if (options.stop_rule.empty()) return options.quality ? StopRule::Quality : StopRule::NothingNew;
  if (!strategy.ends_by_stop_rule && options.planner.empty()) {
    throw SetupError(fmt::format("--stop-rule: --strategy {} ends by itself, without these rules",
                                 strategy.name));
  }
  const auto rule = stop_rule_from_string(options.stop_rule);
  if (!rule) throw SetupError("--stop-rule: there is no rule '" + options.stop_rule + "'");
  return *rule;
}

void fill_planner(run_config_t& config, const RunOptions& options) {
  if (options.step_min_m > options.step_max_m) {
    throw SetupError("--step-min must not be above --step-max");
  }
  const StrategyFacts* strategy = find_strategy(options.strategy);
  if (strategy == nullptr) throw SetupError("--strategy: " + no_such_strategy(options.strategy));
  if (!strategy->weighs_factors &&
      (options.structure_weight != 0.0 || options.navigation_weight != 0.0)) {
    throw SetupError(
        "--structure-weight and --navigation-weight weigh the paper's fitness, which --strategy " +
        options.strategy + " does not have: give --strategy paper, or for the way --path-cost");
  }
  config.planner.structure_weight = options.structure_weight;
  config.planner.navigation_weight = options.navigation_weight;
  config.planner.max_views =
      options.views.value_or(options.quality ? strategy->views_with_quality : strategy->views);
  config.planner.max_attempts = options.max_attempts;
  config.planner.quality_weight = options.quality ? 1.0 : 0.0;
  config.planner.stop_rule = static_cast<std::int8_t>(stop_rule_of(options, *strategy));
  config.planner.quality_threshold = options.quality_threshold;
  config.planner.clearance_m = options.clearance_m;
  config.planner.departure_m = options.departure_m;
  config.planner.later_departure_m = std::min(options.later_departure_m, options.departure_m);
  config.planner.path_cost_per_m = options.path_cost_per_m;
  config.planner.least_overlap = options.least_overlap;
  config.planner.least_gain_m2 = options.least_gain_m2;
  config.planner.return_home = options.return_home;
  config.planner.directions = options.directions.value_or(strategy->directions);
  fill_prediction_rays(config.planner, options.prediction_rays);
  config.planner.threads = options.threads;
  config.planner.step_min_m = options.step_min_m;
  config.planner.step_max_m = options.step_max_m;
  config.planner.fitness_tolerance = options.fitness_tolerance;
  config.planner.max_evaluations = options.max_evaluations;
  config.planner.stop_window_views = options.stop_window_views;
  config.planner.stop_new_area_m2 = options.stop_new_area_m2;
}

std::string lift_in_words(const run_config_t& config, double floor_m) {
  return fmt::format(
      "the floor under the start is at {:.2f} m; the lift moves the sensor from "
      "{:.2f} to {:.2f} m (--lift-min, --lift-max)",
      floor_m, config.base.lift_min_m, config.base.lift_max_m);
}

/// The start must be a place where the base can be, and at the planner's clearance, or nothing
/// could be planned from it.
void check_start(const run_config_t& config, double floor_m, const Scene& scene) {
  const SensorPose start = start_pose_of(config);
  const double height_m = start.position_m.z();
  if (height_m < config.base.lift_min_m || height_m > config.base.lift_max_m) {
    throw SetupError(fmt::format("--start: a height of {:.2f} m is beyond the lift: {}", height_m,
                                 lift_in_words(config, floor_m)));
  }
  try {
    const Base base(base_limits_of(config), start, scene);
  } catch (const std::invalid_argument& error) {
    throw SetupError("--start: " + std::string(error.what()));
  }
  const double clearance_m =
      scene.clearance_m(start.position_m, start.position_m, config.planner.clearance_m);
  if (clearance_m < config.planner.clearance_m) {
    throw SetupError(
        fmt::format("--start: too near an obstacle, {:.2f} m where the planner keeps {:.2f} m: "
                    "start elsewhere, or give a smaller --clearance",
                    clearance_m, config.planner.clearance_m));
  }
}

/// What does not depend on where the scene comes from.
/// @return the height of the floor under the start
double fill_rest(run_config_t& config, const RunOptions& options,
                 const SceneDescription& description, const Eigen::Vector3d& start_m,
                 const Scene* scene, const Eigen::AlignedBox3d& bounds) {
  config.seed = options.seed;
  config.scene_name = description.name;
  config.program_version = program_version();
  config.strategy = options.strategy;
  fill_start(config, options, description, start_m);
  fill_sensor(config.sensor, sensor_given(options));
  const double floor_m = floor_under_start_m(config, scene, bounds);
  fill_base(config, options, bounds, floor_m);
  fill_map(config, options, bounds);
  fill_planner(config, options);
  if (const std::string reason = check(config); !reason.empty()) {
    throw SetupError("the configuration cannot be right: " + reason);
  }
  return floor_m;
}

RunSetup prepare_in_scene(const RunOptions& options) {
  if (!options.workspace_m.empty()) {
    throw SetupError("--workspace goes with --without sensor_sim,base_sim: a scene has its own");
  }
  const SceneDescription description =
      find_scene(options.scene.value_or("boxes"), options.scenes_folder, given_options(options));
  TriangleMesh mesh = load_mesh(description.file, description.options);
  const Eigen::AlignedBox3d bounds = mesh.bounds_m();

  RunSetup setup;
  run_config_t& config = setup.config;
  config.has_scene = 1;
  config.scene_file = std::filesystem::absolute(description.file).lexically_normal().string();
  config.scene.unit_m = description.options.unit_m.value_or(0.0);
  if (description.options.up) config.scene_up = name_of(*description.options.up);
  config.scene_digest = mesh_digest(mesh);
  for (int axis = 0; axis < 3; ++axis) {
    config.scene.origin_in_file_m[axis] = mesh.origin_in_file_m[axis];
  }
  if (!mesh.origin_in_file_m.isZero(0.0)) {
    setup.warnings.push_back(fmt::format(
        "the model lies far from its origin: the run's positions are the file's less "
        "({:.2f}, {:.2f}, {:.2f}) m; --start is the file's own",
        mesh.origin_in_file_m.x(), mesh.origin_in_file_m.y(), mesh.origin_in_file_m.z()));
  }
  setup.scene = std::make_shared<const Scene>(std::move(mesh));
  const Eigen::Vector3d start_m = start_in_scene(options, description, *setup.scene);
  if (options.start_auto) {
    setup.notes.push_back("starts where it sees most: " + as_option(start_m, *setup.scene));
  }
  const double floor_m =
      fill_rest(config, options, description, start_m, setup.scene.get(), bounds);
  check_start(config, floor_m, *setup.scene);
  setup.notes.push_back(lift_in_words(config, floor_m));
  const double escape = escape_share(*setup.scene, start_pose_of(config).position_m);
  if (escape > 0.0) {
    setup.warnings.push_back(
        fmt::format("{:.2f} % of the rays from the start meet no surface: the scene is not closed, "
                    "and where nothing is met nothing can be recovered",
                    100.0 * escape));
  }
  return setup;
}

/// Without simulators nobody needs a scene; the user says what it would have said.
RunSetup prepare_without_scene(const RunOptions& options) {
  if (options.scene || options.unit || options.up) {
    throw SetupError(
        "without simulators there is no SCENE, --unit or --up: give --start and --workspace only");
  }
  if (options.start_m.empty() || options.workspace_m.empty()) {  // also --start auto
    throw SetupError(
        "--without sensor_sim,base_sim needs --start X Y Z and --workspace X0 Y0 Z0 X1 Y1 Z1");
  }
  const Eigen::AlignedBox3d bounds(Eigen::Vector3d(options.workspace_m.data()),
                                   Eigen::Vector3d(options.workspace_m.data() + 3));
  if ((bounds.sizes().array() <= 0.0).any()) {
    throw SetupError("--workspace: X0 Y0 Z0 must be below X1 Y1 Z1");
  }
  SceneDescription description;
  description.name = "robot";
  RunSetup setup;
  fill_rest(setup.config, options, description, Eigen::Vector3d(options.start_m.data()), nullptr,
            bounds);
  const base_config_t& base = setup.config.base;
  if (!bounds.contains(Eigen::Vector3d(base.start_m)) || base.start_m[2] < base.lift_min_m ||
      base.start_m[2] > base.lift_max_m) {
    throw SetupError(
        fmt::format("--start: outside --workspace, or not between --lift-min, {:.2f} "
                    "m, and --lift-max, {:.2f} m",
                    base.lift_min_m, base.lift_max_m));
  }
  return setup;
}

}  // namespace

RunSetup prepare_run(const RunOptions& options) {
  const auto without = [&options](const char* role) {
    return std::find(options.without.begin(), options.without.end(), role) != options.without.end();
  };
  return without("sensor_sim") && without("base_sim") ? prepare_without_scene(options)
                                                      : prepare_in_scene(options);
}

ViewBoundQuestion bound_question_of(const RunOptions& options, const run_config_t& config) {
  ViewBoundQuestion question;
  question.start = start_pose_of(config);
  question.visibility = visibility_of(config);
  question.poses.sensor = sensor_of(config);
  question.poses.limits = range_limits_of(config);
  question.poses.grid = grid_of(config);
  question.poses.spacing_m = options.bound_spacing_m;
  return question;
}

}  // namespace nextview
