#include "runner/run_setup.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <optional>
#include <utility>

#include "base_sim/base_sim_process.h"
#include "lcmtypes/program_version.h"
#include "lcmtypes/validate.h"
#include "mapper/mapper_config.h"
#include "scene/enclosure.h"
#include "scene/scene_catalog.h"
#include "sensor/sensor_config.h"

namespace nextview {
namespace {

constexpr double kRadPerDegree = std::numbers::pi / 180.0;

std::string two_decimals(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

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

/// The user's start is in the file's frame, the run's and its bounds are in the world's.
void fill_start(run_config_t& config, const RunOptions& options, const SceneDescription& scene,
                const Eigen::AlignedBox3d& bounds) {
  const Eigen::Vector3d origin_in_file_m(config.scene.origin_in_file_m);
  std::optional<Eigen::Vector3d> start_m = scene.start_m;
  if (!options.start_m.empty()) start_m = Eigen::Vector3d(options.start_m.data());
  if (!start_m) {
    const Eigen::Vector3d min = bounds.min() + origin_in_file_m;
    const Eigen::Vector3d max = bounds.max() + origin_in_file_m;
    throw SetupError(scene.file.string() + " says no start position: give --start X Y Z, inside (" +
                     two_decimals(min.x()) + " .. " + two_decimals(max.x()) + ", " +
                     two_decimals(min.y()) + " .. " + two_decimals(max.y()) + ", " +
                     two_decimals(min.z()) + " .. " + two_decimals(max.z()) + ") m");
  }
  for (int axis = 0; axis < 3; ++axis) {
    config.base.start_m[axis] = (*start_m)[axis] - origin_in_file_m[axis];
  }
  config.base.start_pan_rad = scene.start_pan_rad.value_or(0.0);
  if (options.start_pan_deg) config.base.start_pan_rad = *options.start_pan_deg * kRadPerDegree;
  config.base.start_tilt_rad = options.start_tilt_deg * kRadPerDegree;
}

void fill_sensor(run_config_t& config, const RunOptions& options) {
  if (options.range.min_m >= options.range.max_m) {
    throw SetupError("--range-min must be below --range-max");
  }
  const TiltedLineScan sensor = TiltedLineScan::with_aperture(options.columns, options.rows,
                                                              options.aperture_deg * kRadPerDegree);
  config.sensor.columns = sensor.columns;
  config.sensor.rows = sensor.rows;
  config.sensor.geometry_parameter[0] = sensor.horizontal_aperture_rad;
  config.sensor.geometry_parameter[1] = sensor.vertical_aperture_rad;
  config.sensor.range_min_m = options.range.min_m;
  config.sensor.range_max_m = options.range.max_m;
  config.sensor.range_noise_m = options.range_noise_m;
  config.sensor.scan_duration_s = options.scan_duration_s;
}

void fill_base(run_config_t& config, const RunOptions& options, const Eigen::AlignedBox3d& bounds) {
  constexpr double kReach_m = 2.8;  // of the lift, above the lowest floor
  config.base.body_radius_m = options.body_radius_m;
  for (int axis = 0; axis < 3; ++axis) {
    config.base.workspace_min_m[axis] = bounds.min()[axis];
    config.base.workspace_max_m[axis] = bounds.max()[axis];
  }
  const double floor_m = bounds.min().z();
  config.base.lift_min_m = options.lift_min_m.value_or(floor_m + options.body_radius_m);
  config.base.lift_max_m = options.lift_max_m.value_or(
      std::min(bounds.max().z() - options.body_radius_m, floor_m + kReach_m));
  if (config.base.lift_min_m >= config.base.lift_max_m) {
    throw SetupError("the sensor's lowest height, " + two_decimals(config.base.lift_min_m) +
                     " m, is not below its highest, " + two_decimals(config.base.lift_max_m) +
                     " m: see --lift-min, --lift-max, --body-radius and --unit");
  }
  config.base.base_speed_m_s = options.base_speed_m_s;
  config.base.lift_speed_m_s = options.lift_speed_m_s;
  config.base.turn_speed_rad_s = options.turn_speed_deg_s * kRadPerDegree;
}

void fill_map(run_config_t& config, const RunOptions& options, const Eigen::AlignedBox3d& bounds) {
  constexpr double kLargestSide = 4096.0;
  config.map.voxel_size_m = options.voxel_size_m;
  const double sides = bounds.sizes().maxCoeff() / options.voxel_size_m + 2 * options.margin_voxels;
  if (sides > kLargestSide - 2.0) {
    throw SetupError(
        "the scene is " + two_decimals(bounds.sizes().maxCoeff()) +
        " m long, more than the 4096 voxels a map may have: give a larger --voxel-size, "
        "or the right --unit");
  }
  const VoxelGrid grid = grid_of(config);
  const VoxelIndex margin = VoxelIndex::Constant(options.margin_voxels);
  const VoxelIndex min = grid.voxel_of(bounds.min()) - margin;
  const VoxelIndex max = grid.voxel_of(bounds.max()) + margin;
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

void fill_planner(run_config_t& config, const RunOptions& options) {
  if (options.step_min_m > options.step_max_m) {
    throw SetupError("--step-min must not be above --step-max");
  }
  const bool paper = options.strategy == PaperStrategy::kName;
  const int views = !paper ? 1000 : options.quality ? 300 : 60;
  config.planner.max_views = options.views.value_or(views);
  config.planner.max_attempts = options.max_attempts;
  config.planner.quality_weight = options.quality ? 1.0 : 0.0;
  config.planner.stop_rule = options.quality ? 2 : 1;
  config.planner.quality_threshold = options.quality_threshold;
  config.planner.clearance_m = options.clearance_m;
  config.planner.departure_m = options.departure_m;
  config.planner.later_departure_m = std::min(options.later_departure_m, options.departure_m);
  config.planner.path_cost_per_m = options.path_cost_per_m;
  config.planner.least_overlap = options.least_overlap;
  config.planner.least_gain_m2 = options.least_gain_m2;
  config.planner.return_home = options.return_home;
  config.planner.directions = options.directions.value_or(paper ? 20 : 320);
  config.planner.threads = options.threads;
  config.planner.step_min_m = options.step_min_m;
  config.planner.step_max_m = options.step_max_m;
  config.planner.fitness_tolerance = options.fitness_tolerance;
  config.planner.max_evaluations = options.max_evaluations;
  config.planner.stop_window_views = options.stop_window_views;
  config.planner.stop_new_area_m2 = options.stop_new_area_m2;
}

/// The start must be a place where the base can be, and at the planner's clearance, or nothing
/// could be planned from it.
void check_start(const run_config_t& config, const Scene& scene) {
  const SensorPose start = start_pose_of(config);
  try {
    const Base base(base_limits_of(config), start, scene);
  } catch (const std::invalid_argument& error) {
    throw SetupError("--start: " + std::string(error.what()));
  }
  const double clearance_m =
      scene.clearance_m(start.position_m, start.position_m, config.planner.clearance_m);
  if (clearance_m < config.planner.clearance_m) {
    throw SetupError("--start: too near an obstacle, " + two_decimals(clearance_m) +
                     " m where the planner keeps " + two_decimals(config.planner.clearance_m) +
                     " m: start elsewhere, or give a smaller --clearance");
  }
}

/// What does not depend on where the scene comes from.
void fill_rest(run_config_t& config, const RunOptions& options, const SceneDescription& description,
               const Eigen::AlignedBox3d& bounds) {
  config.seed = options.seed;
  config.scene_name = description.name;
  config.program_version = program_version();
  config.strategy = options.strategy;
  fill_start(config, options, description, bounds);
  fill_sensor(config, options);
  fill_base(config, options, bounds);
  fill_map(config, options, bounds);
  fill_planner(config, options);
  if (const std::string reason = check(config); !reason.empty()) {
    throw SetupError("the configuration cannot be right: " + reason);
  }
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
    setup.warnings.push_back(
        "the model lies far from its origin: the run's positions are the file's less (" +
        two_decimals(mesh.origin_in_file_m.x()) + ", " + two_decimals(mesh.origin_in_file_m.y()) +
        ", " + two_decimals(mesh.origin_in_file_m.z()) + ") m; --start is the file's own");
  }
  fill_rest(config, options, description, bounds);

  setup.scene = std::make_shared<const Scene>(std::move(mesh));
  check_start(config, *setup.scene);
  const double escape = escape_share(*setup.scene, start_pose_of(config).position_m);
  if (escape > 0.0) {
    setup.warnings.push_back(two_decimals(100.0 * escape) +
                             " % of the rays from the start meet no surface: the scene is not "
                             "closed, and where nothing is met nothing can be recovered");
  }
  return setup;
}

/// Without simulators nobody needs a scene; the user says what it would have said.
RunSetup prepare_without_scene(const RunOptions& options) {
  if (options.scene || options.unit || options.up) {
    throw SetupError(
        "without simulators there is no SCENE, --unit or --up: give --start and --workspace only");
  }
  if (options.start_m.empty() || options.workspace_m.empty()) {
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
  fill_rest(setup.config, options, description, bounds);
  const base_config_t& base = setup.config.base;
  if (!bounds.contains(Eigen::Vector3d(base.start_m)) || base.start_m[2] < base.lift_min_m ||
      base.start_m[2] > base.lift_max_m) {
    throw SetupError("--start: outside --workspace, or not between --lift-min, " +
                     two_decimals(base.lift_min_m) + " m, and --lift-max, " +
                     two_decimals(base.lift_max_m) + " m");
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

VisibilityParameters visibility_of(const run_config_t& config) {
  VisibilityParameters visibility;
  visibility.range_max_m = config.sensor.range_max_m;
  ReachParameters& reach = visibility.reach;
  reach.clearance_m = config.planner.clearance_m;
  reach.box_min_m = Eigen::Vector3d(config.base.workspace_min_m);
  reach.box_max_m = Eigen::Vector3d(config.base.workspace_max_m);
  reach.box_min_m.z() = std::max(reach.box_min_m.z(), config.base.lift_min_m);
  reach.box_max_m.z() = std::min(reach.box_max_m.z(), config.base.lift_max_m);
  return visibility;
}

ViewBoundQuestion bound_question_of(const RunOptions& options, const run_config_t& config) {
  ViewBoundQuestion question;
  question.start = start_pose_of(config);
  question.visibility = visibility_of(config);
  question.poses.sensor = TiltedLineScan::with_aperture(options.columns, options.rows,
                                                        options.aperture_deg * kRadPerDegree);
  question.poses.limits = options.range;
  question.poses.grid = grid_of(config);
  question.poses.spacing_m = options.bound_spacing_m;
  return question;
}

}  // namespace nextview
