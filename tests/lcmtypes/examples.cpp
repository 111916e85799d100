#include "tests/lcmtypes/examples.h"

#include <cmath>
#include <limits>
#include <string>

namespace nextview {

using namespace std::string_literals;

template <>
run_config_t example() {
  run_config_t config{};
  config.run = 7;
  config.seed = 3;
  config.scene.unit_m = 1.0;
  config.base.start_m[2] = 1.2;
  config.has_scene = 1;
  config.sensor.columns = 4;
  config.sensor.rows = 3;
  config.sensor.geometry_parameter[0] = 1.0;
  config.sensor.geometry_parameter[1] = 0.7;
  config.sensor.range_min_m = 0.05;
  config.sensor.range_max_m = 30.0;
  config.sensor.scan_duration_s = 1.0;
  config.base.body_radius_m = 0.2;
  for (int axis = 0; axis < 3; ++axis) {
    config.base.workspace_min_m[axis] = -2.0;
    config.base.workspace_max_m[axis] = 3.0;
    config.map.window_size[axis] = 16;
  }
  config.base.lift_min_m = 0.3;
  config.base.lift_max_m = 2.0;
  config.base.base_speed_m_s = 0.5;
  config.base.lift_speed_m_s = 0.2;
  config.base.turn_speed_rad_s = 0.7;
  config.map.voxel_size_m = 0.1;
  config.planner.stop_rule = 1;
  config.planner.max_views = 60;
  config.planner.max_attempts = 20;
  config.planner.quality_threshold = 0.8;
  config.planner.clearance_m = 0.4;
  config.planner.departure_m = 0.8;
  config.planner.directions = 20;
  config.planner.threads = 1;
  config.planner.step_min_m = 0.3;
  config.planner.step_max_m = 1.5;
  config.planner.fitness_tolerance = 0.01;
  config.planner.max_evaluations = 70;
  config.planner.stop_window_views = 15;
  config.planner.stop_new_area_m2 = 0.1;
  config.scene_name = "room"s;
  config.scene_file = "room.obj"s;
  config.scene_up = "z"s;
  config.scene_digest = "0123456789abcdef0123456789abcdef"s;
  config.strategy = "paper"s;
  config.program_version = "0.1"s;
  return config;
}

template <>
goal_t example() {
  goal_t goal{};
  goal.utime = 5;
  goal.run = 7;
  goal.view = 2;
  goal.attempt = 1;
  goal.position_m[0] = 1.0;
  goal.waypoints = 2;
  goal.waypoint_m = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}};
  goal.fitness = 0.9;
  goal.share_occupied = 0.5;
  goal.share_unseen = 0.5;
  goal.path_length_m = 1.0;
  goal.factors = 2;
  goal.factor_value = {0.25, 0.0};
  goal.factor_names = "quality,structure"s;
  goal.strategy = "paper"s;
  goal.reason = "the best of 9 positions"s;
  return goal;
}

template <>
search_t example() {
  search_t search{};
  search.run = 7;
  search.view = 2;
  search.attempt = 1;
  search.tried = 2;
  search.tried_position_m = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}};
  search.tried_pan_rad = {0.0, 1.0};
  search.tried_tilt_rad = {0.0, 0.5};
  search.tried_fitness = {-1.0, 0.9};
  search.tried_move = {0, 5};
  return search;
}

template <>
arrival_t example() {
  arrival_t arrival{};
  arrival.run = 7;
  arrival.view = 2;
  arrival.attempt = 1;
  arrival.refusal = "the body would touch a surface"s;
  return arrival;
}

template <>
range_image_t example() {
  range_image_t image{};
  image.run = 7;
  image.view = 2;
  image.attempt = 1;
  image.columns = 3;
  image.rows = 2;
  image.entries = 5;
  image.pixels = 6;
  image.parts = 1;
  for (int i = 0; i < 3; ++i) {
    image.entry_sin.push_back(std::sin(0.1 * i));
    image.entry_cos.push_back(std::cos(0.1 * i));
    image.world_from_sensor[i][i] = 1.0;
  }
  image.entry_sin.insert(image.entry_sin.end(), {0.0, 0.6});
  image.entry_cos.insert(image.entry_cos.end(), {1.0, 0.8});
  image.range_min_m = 0.05;
  image.range_max_m = 30.0;
  image.range_m = {
      1.0F, 2.0F, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN(),
      5.0F, 30.0F};
  return image;
}

template <>
commit_t example() {
  commit_t commit{};
  commit.run = 7;
  commit.view = 2;
  commit.attempt = 1;
  commit.occupied_voxels = 10;
  commit.newly_occupied_voxels = 4;
  commit.mean_quality = 0.7;
  commit.min_quality = 0.1;
  commit.map_digest = "0123456789abcdef0123456789abcdef"s;
  commit.history_digest = "fedcba9876543210fedcba9876543210"s;
  return commit;
}

template <>
stop_t example() {
  stop_t stop{};
  stop.run = 7;
  stop.views = 2;
  stop.stop_reason = "view_limit"s;
  return stop;
}

template <>
status_t example() {
  status_t status{};
  status.run = 7;
  status.role = "mapper"s;
  status.program_version = "0.1"s;
  return status;
}

template <>
request_t example() {
  request_t request{};
  request.run = 7;
  request.view = 2;
  request.wanted_channel = "NEXTVIEW_GOAL"s;
  request.asker = "mapper"s;
  return request;
}

template <>
timing_t example() {
  timing_t timing{};
  timing.run = 7;
  timing.view = 2;
  timing.attempt = 1;
  timing.durations = 2;
  timing.duration_s = {0.002, 0.0001};
  timing.role = "mapper"s;
  timing.duration_names = "update,digest"s;
  return timing;
}

template <>
map_blocks_t example() {
  map_blocks_t blocks{};
  blocks.run = 7;
  blocks.view = 2;
  blocks.since_view = 1;
  blocks.parts = 1;
  blocks.voxel_size_m = 0.1;
  for (std::int32_t& size : blocks.window_size) size = 16;
  blocks.blocks = 2;
  blocks.block_index = {{0, 0, 0}, {-1, 0, 1}};
  blocks.block_label.assign(2, std::vector<std::uint8_t>(512, 3));
  blocks.block_label[1][511] = 4;
  blocks.surfaces = 1;
  blocks.surface_normal = {{0.0F, 0.6F, 0.8F}};
  blocks.surface_quality = {0.75F};
  return blocks;
}

template <>
pace_t example() {
  pace_t pace{};
  pace.run = 7;
  pace.pace_number = 12;
  pace.last_view = 3;
  pace.holds_s = 2.0;
  return pace;
}

template <>
parts_request_t example() {
  parts_request_t request{};
  request.run = 7;
  request.view = 2;
  request.attempt = 1;
  request.ranges = 2;
  request.first_wanted_part = {0, 4};
  request.last_wanted_part = {0, 9};
  request.wanted_channel = "NEXTVIEW_RANGE_IMAGE"s;
  request.asker = "mapper"s;
  return request;
}

template <>
recorded_t example() {
  recorded_t recorded{};
  recorded.run = 7;
  recorded.recorded_views = 3;
  return recorded;
}

}  // namespace nextview
