#include "lcmtypes/validate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "lcmtypes/parameter_bounds.h"
#include "tests/lcmtypes/examples.h"

namespace nextview {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfF = std::numeric_limits<float>::infinity();

/// A change to a valid message that makes it impossible.
template <class Message>
struct Fault {
  std::string name;
  std::function<void(Message&)> apply;
};

template <class Message>
void expect_all_refused(const std::vector<Fault<Message>>& faults) {
  EXPECT_EQ(check(example<Message>()), "");
  for (const Fault<Message>& fault : faults) {
    Message message = example<Message>();
    fault.apply(message);
    EXPECT_NE(check(message), "") << fault.name;
  }
}

TEST(Validate, Goal) {
  expect_all_refused<goal_t>({
      {"view 0", [](goal_t& m) { m.view = 0; }},
      {"negative view", [](goal_t& m) { m.view = -3; }},
      {"attempt 0", [](goal_t& m) { m.attempt = 0; }},
      {"negative utime", [](goal_t& m) { m.utime = -1; }},
      {"NaN position", [](goal_t& m) { m.position_m[1] = kNan; }},
      {"infinite position", [](goal_t& m) { m.position_m[1] = -kInf; }},
      {"NaN pan", [](goal_t& m) { m.pan_rad = kNan; }},
      {"tilt beyond the vertical", [](goal_t& m) { m.tilt_rad = 1.6; }},
      {"NaN waypoint", [](goal_t& m) { m.waypoint_m[1][2] = kNan; }},
      {"no waypoint", [](goal_t& m) { m.waypoints = 0; }},
      {"NaN fitness", [](goal_t& m) { m.fitness = kNan; }},
      {"share above 1", [](goal_t& m) { m.share_unseen = 1.01; }},
      {"negative share", [](goal_t& m) { m.share_open = -0.01; }},
      {"negative iterations", [](goal_t& m) { m.iterations = -1; }},
      {"negative path", [](goal_t& m) { m.path_length_m = -1.0; }},
      {"factor above 1", [](goal_t& m) { m.factor_value[1] = 1.5; }},
      {"NaN factor", [](goal_t& m) { m.factor_value[0] = kNan; }},
      {"fewer names than factors", [](goal_t& m) { m.factor_names = "quality"; }},
      {"more names than factors", [](goal_t& m) { m.factor_names += ",navigation"; }},
      {"a factor without a name", [](goal_t& m) { m.factor_names = "quality,"; }},
      {"a name of two words", [](goal_t& m) { m.factor_names = "quality,my structure"; }},
      {"no strategy", [](goal_t& m) { m.strategy.clear(); }},
      {"negative gain", [](goal_t& m) { m.expected_gain_m2 = -0.5; }},
      {"overlap above 1", [](goal_t& m) { m.overlap = 1.5; }},
  });
}

TEST(Validate, Search) {
  expect_all_refused<search_t>({
      {"view 0", [](search_t& m) { m.view = 0; }},
      {"NaN position", [](search_t& m) { m.tried_position_m[1][0] = kNan; }},
      {"infinite fitness", [](search_t& m) { m.tried_fitness[0] = -kInf; }},
      {"NaN pan", [](search_t& m) { m.tried_pan_rad[0] = kNan; }},
      {"unknown move", [](search_t& m) { m.tried_move[0] = 16; }},
      {"negative move", [](search_t& m) { m.tried_move[0] = -1; }},
  });
}

TEST(Validate, Arrival) {
  expect_all_refused<arrival_t>({
      {"view 0", [](arrival_t& m) { m.view = 0; }},
      {"both arrived and refused", [](arrival_t& m) { m.arrived = 1; }},
      {"neither", [](arrival_t& m) { m.refusal.clear(); }},
      {"a boolean of 2", [](arrival_t& m) { m.arrived = 2; }},
      {"NaN true position", [](arrival_t& m) { m.true_position_m[0] = kNan; }},
      {"NaN believed position", [](arrival_t& m) { m.believed_position_m[2] = kNan; }},
      {"NaN true pan", [](arrival_t& m) { m.true_pan_rad = kNan; }},
      {"believed tilt beyond the vertical", [](arrival_t& m) { m.believed_tilt_rad = 1.6; }},
      {"negative path", [](arrival_t& m) { m.path_length_m = -0.1; }},
  });
}

TEST(Validate, RangeImage) {
  expect_all_refused<range_image_t>({
      {"view 0", [](range_image_t& m) { m.view = 0; }},
      {"unknown geometry", [](range_image_t& m) { m.geometry = 3; }},
      {"geometry below 0", [](range_image_t& m) { m.geometry = -1; }},
      {"one column", [](range_image_t& m) { m.columns = 1; }},
      {"rows without end", [](range_image_t& m) { m.rows = 1 << 20; }},
      {"more entries than the raster", [](range_image_t& m) { m.first_entry = 1; }},
      {"negative first entry", [](range_image_t& m) { m.first_entry = -1; }},
      {"entries that leave a gap to the pixels", [](range_image_t& m) { m.entries = 4; }},
      {"entries without the pixels that end the image", [](range_image_t& m) { m.pixels = 0; }},
      {"nothing in it",
       [](range_image_t& m) {
         m.parts = 3;
         m.part = 1;
         m.first_entry = 5;
         m.entries = m.pixels = 0;
       }},
      {"pixels in the midst of the image right behind its entries",
       [](range_image_t& m) {
         m.parts = 2;
         m.part = 0;
         m.first_pixel = 1;
         m.pixels = 3;
       }},
      {"more pixels than the raster", [](range_image_t& m) { m.first_pixel = 1; }},
      {"negative first pixel", [](range_image_t& m) { m.first_pixel = -1; }},
      {"first pixel whose sum overflows",
       [](range_image_t& m) { m.first_pixel = std::numeric_limits<std::int32_t>::max(); }},
      {"no pixels", [](range_image_t& m) { m.pixels = 0; }},
      {"fewer pixels than the raster in its only part", [](range_image_t& m) { m.pixels = 5; }},
      {"part beyond parts", [](range_image_t& m) { m.part = 1; }},
      {"negative part", [](range_image_t& m) { m.part = -1; }},
      {"no parts", [](range_image_t& m) { m.parts = 0; }},
      {"more parts than entries and pixels", [](range_image_t& m) { m.parts = 12; }},
      {"second part from the first entry",
       [](range_image_t& m) {
         m.parts = 3;
         m.part = 1;
       }},
      {"column off the unit circle", [](range_image_t& m) { m.entry_sin[1] += 1e-4; }},
      {"NaN row", [](range_image_t& m) { m.entry_cos[3] = kNan; }},
      {"limits the wrong way round", [](range_image_t& m) { m.range_min_m = 31.0; }},
      {"negative limit", [](range_image_t& m) { m.range_min_m = -1.0; }},
      {"infinite limit", [](range_image_t& m) { m.range_max_m = kInf; }},
      {"NaN position", [](range_image_t& m) { m.position_m[0] = kNan; }},
      {"rotation stretched", [](range_image_t& m) { m.world_from_sensor[0][0] = 1.0001; }},
      {"rotation mirrored", [](range_image_t& m) { m.world_from_sensor[0][0] = -1.0; }},
      {"rotation NaN", [](range_image_t& m) { m.world_from_sensor[2][1] = kNan; }},
      {"negative range", [](range_image_t& m) { m.range_m[0] = -0.1F; }},
      {"range of -inf", [](range_image_t& m) { m.range_m[0] = -kInfF; }},
  });
}

// A part of 60 ranges, one of them set to a value: any place will do, and none hides a wrong one.
TEST(Validate, RangesWhereverTheyStand) {
  auto image = example<range_image_t>();
  image.rows = 20;
  image.pixels = 60;
  image.entries = 23;
  image.entry_sin.assign(23, 0.0);
  image.entry_cos.assign(23, 1.0);
  image.range_m.assign(60, kInfF);
  ASSERT_EQ(check(image), "");
  for (float& range_m : image.range_m) {
    // Outside the limits a range says that it is invalid, or that there is no return.
    for (const float right :
         {0.0F, -0.0F, 0.01F, 30.0F, 30.1F, std::numeric_limits<float>::max(), kNanF, kInfF}) {
      range_m = right;
      EXPECT_EQ(check(image), "") << right;
    }
    for (const float wrong : {-std::numeric_limits<float>::denorm_min(), -1.0F, -kInfF}) {
      range_m = wrong;
      EXPECT_EQ(check(image), "a range is negative or -inf") << wrong;
    }
    range_m = kNanF;
  }
}

// A driver that works in 32-bit floats.
TEST(Validate, SinesAndRotationsOf32BitFloats) {
  auto image = example<range_image_t>();
  const float angle = 0.7F;
  image.entry_sin[1] = static_cast<double>(std::sin(angle));
  image.entry_cos[1] = static_cast<double>(std::cos(angle));
  const double turned[3][3] = {
      {static_cast<double>(std::cos(angle)), static_cast<double>(-std::sin(angle)), 0.0},
      {static_cast<double>(std::sin(angle)), static_cast<double>(std::cos(angle)), 0.0},
      {0.0, 0.0, 1.0}};
  std::memcpy(image.world_from_sensor, turned, sizeof turned);
  image.tilt_rad = static_cast<double>(std::numbers::pi_v<float> / 2.0F);  // a little more
  EXPECT_EQ(check(image), "");
}

TEST(Validate, Commit) {
  expect_all_refused<commit_t>({
      {"view 0", [](commit_t& m) { m.view = 0; }},
      {"negative count", [](commit_t& m) { m.empty_voxels = -1; }},
      {"more new than all", [](commit_t& m) { m.newly_occupied_voxels = 11; }},
      {"NaN area", [](commit_t& m) { m.occupied_area_m2 = kNan; }},
      {"quality above 1", [](commit_t& m) { m.mean_quality = 1.1; }},
      {"NaN quality", [](commit_t& m) { m.min_quality = kNan; }},
      {"short digest", [](commit_t& m) { m.map_digest.pop_back(); }},
      {"digest with another letter", [](commit_t& m) { m.map_digest[3] = 'g'; }},
      {"no history", [](commit_t& m) { m.history_digest.clear(); }},
      {"NaN position", [](commit_t& m) { m.used_position_m[0] = kNan; }},
  });
}

TEST(Validate, TheRest) {
  expect_all_refused<stop_t>({
      {"negative views", [](stop_t& m) { m.views = -1; }},
      {"no reason", [](stop_t& m) { m.stop_reason.clear(); }},
  });
  expect_all_refused<status_t>({
      {"negative counter", [](status_t& m) { m.refused = -1; }},
      {"a boolean of -1", [](status_t& m) { m.failed = -1; }},
      {"no role", [](status_t& m) { m.role.clear(); }},
      {"no version", [](status_t& m) { m.program_version.clear(); }},
  });
  expect_all_refused<request_t>({
      {"negative view", [](request_t& m) { m.view = -1; }},
      {"negative attempt", [](request_t& m) { m.attempt = -1; }},
      {"a channel nobody has", [](request_t& m) { m.wanted_channel = "NEXTVIEW_GOALS"; }},
      {"no asker", [](request_t& m) { m.asker.clear(); }},
  });
}

TEST(Validate, Timing) {
  expect_all_refused<timing_t>({
      {"negative utime", [](timing_t& m) { m.utime = -1; }},
      {"view 0", [](timing_t& m) { m.view = 0; }},
      {"negative attempt", [](timing_t& m) { m.attempt = -1; }},
      {"negative duration", [](timing_t& m) { m.duration_s[1] = -1.0; }},
      {"infinite duration", [](timing_t& m) { m.duration_s[0] = kInf; }},
      {"fewer names than durations", [](timing_t& m) { m.duration_names = "update"; }},
      {"no role", [](timing_t& m) { m.role.clear(); }},
  });
}

TEST(Validate, MapBlocks) {
  expect_all_refused<map_blocks_t>({
      {"negative utime", [](map_blocks_t& m) { m.utime = -1; }},
      {"since a negative view", [](map_blocks_t& m) { m.since_view = -1; }},
      {"since a later view", [](map_blocks_t& m) { m.since_view = 3; }},
      {"negative part", [](map_blocks_t& m) { m.part = -1; }},
      {"a part too many", [](map_blocks_t& m) { m.part = 1; }},
      {"no parts", [](map_blocks_t& m) { m.parts = 0; }},
      {"one empty part of two",
       [](map_blocks_t& m) {
         m = example<map_blocks_t>();
         m.parts = 2;
         m.blocks = m.surfaces = 0;
         m.block_index.clear();
         m.block_label.clear();
         m.surface_normal.clear();
         m.surface_quality.clear();
       }},
      {"no voxel size", [](map_blocks_t& m) { m.voxel_size_m = 0.0; }},
      {"NaN origin", [](map_blocks_t& m) { m.map_origin_m[1] = kNan; }},
      {"an empty window", [](map_blocks_t& m) { m.window_size[2] = 0; }},
      {"no label", [](map_blocks_t& m) { m.block_label[0][3] = 5; }},
      {"fewer surfaces than Occupied voxels", [](map_blocks_t& m) { m.block_label[0][3] = 4; }},
      {"more surfaces than Occupied voxels", [](map_blocks_t& m) { m.block_label[1][511] = 3; }},
      {"a long normal", [](map_blocks_t& m) { m.surface_normal[0][0] = 0.1F; }},
      {"NaN normal", [](map_blocks_t& m) { m.surface_normal[0][0] = kNanF; }},
      {"quality above 1", [](map_blocks_t& m) { m.surface_quality[0] = 1.01F; }},
      {"NaN quality", [](map_blocks_t& m) { m.surface_quality[0] = kNanF; }},
  });
  auto nothing_changed = example<map_blocks_t>();
  nothing_changed.blocks = nothing_changed.surfaces = 0;
  nothing_changed.block_index.clear();
  nothing_changed.block_label.clear();
  nothing_changed.surface_normal.clear();
  nothing_changed.surface_quality.clear();
  EXPECT_EQ(check(nothing_changed), "");
}

TEST(Validate, Paces) {
  expect_all_refused<pace_t>({
      {"simulated time", [](pace_t& m) { m.utime = 1; }},
      {"a negative number", [](pace_t& m) { m.pace_number = -1; }},
      {"a negative view", [](pace_t& m) { m.last_view = -1; }},
      {"a hold without end", [](pace_t& m) { m.holds_s = kInf; }},
      {"a hold of two minutes", [](pace_t& m) { m.holds_s = 120.0; }},
      {"a negative hold", [](pace_t& m) { m.holds_s = -1.0; }},
  });
}

TEST(Validate, RequestsForParts) {
  expect_all_refused<parts_request_t>({
      {"no view", [](parts_request_t& m) { m.view = 0; }},
      {"no attempt", [](parts_request_t& m) { m.attempt = 0; }},
      {"no part",
       [](parts_request_t& m) {
         m.ranges = 0;
         m.first_wanted_part.clear();
         m.last_wanted_part.clear();
       }},
      {"a negative part", [](parts_request_t& m) { m.first_wanted_part[0] = -1; }},
      {"a range that ends before it begins", [](parts_request_t& m) { m.last_wanted_part[1] = 3; }},
      {"ranges that overlap", [](parts_request_t& m) { m.first_wanted_part[1] = 0; }},
      {"a channel nobody has", [](parts_request_t& m) { m.wanted_channel = "NEXTVIEW_GOALS"; }},
      {"no asker", [](parts_request_t& m) { m.asker.clear(); }},
  });
}

TEST(Validate, WhatIsRecorded) {
  expect_all_refused<recorded_t>({
      {"simulated time", [](recorded_t& m) { m.utime = 1; }},
      {"a negative view", [](recorded_t& m) { m.recorded_views = -1; }},
  });
}

TEST(Validate, NamesOfAList) {
  EXPECT_EQ(names_of(""), std::vector<std::string_view>{});
  EXPECT_EQ(names_of("a"), std::vector<std::string_view>{"a"});
  EXPECT_EQ(names_of("a,bc,"), (std::vector<std::string_view>{"a", "bc", ""}));
}

// What the planner would refuse, the message says in the planner's own words.
TEST(Validate, SaysWhatAParameterMayBeAsTheLibrariesDo) {
  auto config = example<run_config_t>();
  config.planner.clearance_m = 7.0;
  EXPECT_EQ(check(config), "clearance_m = 7 is not a number from 0 to 5");
  EXPECT_EQ(bounds::kClearance.refusal(7.0), check(config));
  EXPECT_THROW(bounds::kClearance.require(7.0), std::invalid_argument);
  EXPECT_THROW(bounds::kClearance.require(kNan), std::invalid_argument);
  EXPECT_NO_THROW(bounds::kClearance.require(5.0));
  EXPECT_EQ(bounds::kClearance.refusal(0.4), "");
}

TEST(Validate, ARunWithoutAScene) {
  auto config = example<run_config_t>();
  config.has_scene = 0;
  EXPECT_NE(check(config), "") << "a file and a digest of no scene";
  config.scene_file.clear();
  EXPECT_NE(check(config), "") << "a digest of no scene";
  config.scene_digest.clear();
  EXPECT_EQ(check(config), "");
}

TEST(Validate, RunConfig) {
  expect_all_refused<run_config_t>({
      {"utime", [](run_config_t& m) { m.utime = 1; }},
      {"negative unit", [](run_config_t& m) { m.scene.unit_m = -1.0; }},
      {"NaN start", [](run_config_t& m) { m.base.start_m[0] = kNan; }},
      {"tilted over", [](run_config_t& m) { m.base.start_tilt_rad = 2.0; }},
      {"no columns", [](run_config_t& m) { m.sensor.columns = 0; }},
      {"huge rows", [](run_config_t& m) { m.sensor.rows = 1 << 20; }},
      {"a sensor of another geometry", [](run_config_t& m) { m.sensor.geometry = 3; }},
      {"a sensor of geometry -1", [](run_config_t& m) { m.sensor.geometry = -1; }},
      {"a parameter a spherical scanner has no use for",
       [](run_config_t& m) {
         m.sensor.geometry = 1;
         m.sensor.geometry_parameter[2] = 0.1;
       }},
      {"more than a whole turn",
       [](run_config_t& m) {
         m.sensor.geometry = 1;
         m.sensor.geometry_parameter[0] = 6.3;
       }},
      {"a line striper's negative baseline",
       [](run_config_t& m) {
         m.sensor.geometry = 2;
         m.sensor.geometry_parameter[2] = -0.1;
       }},
      {"NaN aperture", [](run_config_t& m) { m.sensor.geometry_parameter[0] = kNan; }},
      {"more rays than a view is predicted with",
       [](run_config_t& m) {
         m.planner.prediction_columns = 1024;
         m.planner.prediction_rows = 32;
       }},
      {"a parameter the geometry has no use for",
       [](run_config_t& m) { m.sensor.geometry_parameter[2] = 0.1; }},
      {"aperture of a half turn", [](run_config_t& m) { m.sensor.geometry_parameter[1] = 3.2; }},
      {"limits the wrong way round", [](run_config_t& m) { m.sensor.range_max_m = 0.01; }},
      {"negative noise", [](run_config_t& m) { m.sensor.range_noise_m = -1.0; }},
      {"workspace inside out", [](run_config_t& m) { m.base.workspace_max_m[2] = -3.0; }},
      {"lift inside out", [](run_config_t& m) { m.base.lift_max_m = 0.1; }},
      {"no speed", [](run_config_t& m) { m.base.lift_speed_m_s = 0.0; }},
      {"voxels of no size", [](run_config_t& m) { m.map.voxel_size_m = 0.0; }},
      {"window of no size", [](run_config_t& m) { m.map.window_size[0] = 0; }},
      {"a start beyond the world", [](run_config_t& m) { m.base.start_m[1] = 2e9; }},
      {"a body without a radius", [](run_config_t& m) { m.base.body_radius_m = 0.0; }},
      {"a clearance the planner would refuse",
       [](run_config_t& m) { m.planner.clearance_m = 7.0; }},
      {"a departure the planner would refuse",
       [](run_config_t& m) { m.planner.departure_m = 5.1; }},
      {"NaN clearance", [](run_config_t& m) { m.planner.clearance_m = kNan; }},
      {"a voxel larger than a room", [](run_config_t& m) { m.map.voxel_size_m = 11.0; }},
      {"a step without end", [](run_config_t& m) { m.planner.step_max_m = kInf; }},
      {"no views", [](run_config_t& m) { m.planner.max_views = 0; }},
      {"no attempts", [](run_config_t& m) { m.planner.max_attempts = 0; }},
      {"threshold above 1", [](run_config_t& m) { m.planner.quality_threshold = 1.5; }},
      {"steps the wrong way round", [](run_config_t& m) { m.planner.step_min_m = 2.0; }},
      {"no face of the icosahedron", [](run_config_t& m) { m.planner.directions = 30; }},
      {"no thread", [](run_config_t& m) { m.planner.threads = 0; }},
      {"too few evaluations", [](run_config_t& m) { m.planner.max_evaluations = 3; }},
      {"more evaluations than a message holds",
       [](run_config_t& m) { m.planner.max_evaluations = 2000; }},
      {"has_scene of 2", [](run_config_t& m) { m.has_scene = 2; }},
      {"an origin out of this world", [](run_config_t& m) { m.scene.origin_in_file_m[1] = 2e9; }},
      {"half the quality", [](run_config_t& m) { m.planner.quality_weight = 0.5; }},
      {"no rule to stop by", [](run_config_t& m) { m.planner.stop_rule = 0; }},
      {"a fourth rule", [](run_config_t& m) { m.planner.stop_rule = 4; }},
      {"columns to predict with", [](run_config_t& m) { m.planner.prediction_columns = 32; }},
      {"rows to predict with", [](run_config_t& m) { m.planner.prediction_rows = 32; }},
      {"more structure than there may be",
       [](run_config_t& m) { m.planner.structure_weight = 10.1; }},
      {"structure in the way", [](run_config_t& m) { m.planner.structure_weight = -1.0; }},
      {"NaN navigation", [](run_config_t& m) { m.planner.navigation_weight = kNan; }},
      {"the surface strategy with structure",
       [](run_config_t& m) {
         m.strategy = "surface";
         m.planner.least_gain_m2 = 0.05;
         m.planner.structure_weight = 1.0;
       }},
      {"the surface strategy with navigation",
       [](run_config_t& m) {
         m.strategy = "surface";
         m.planner.least_gain_m2 = 0.05;
         m.planner.navigation_weight = 1.0;
       }},
      {"a negative path cost", [](run_config_t& m) { m.planner.path_cost_per_m = -0.1; }},
      {"a later departure of 6 m", [](run_config_t& m) { m.planner.later_departure_m = 6.0; }},
      {"an overlap above 1", [](run_config_t& m) { m.planner.least_overlap = 1.2; }},
      {"a gain", [](run_config_t& m) { m.planner.least_gain_m2 = kNan; }},
      {"the way home", [](run_config_t& m) { m.planner.return_home = 2; }},
      {"no strategy", [](run_config_t& m) { m.strategy.clear(); }},
      {"a strategy nobody has", [](run_config_t& m) { m.strategy = "guess"; }},
      {"up is down", [](run_config_t& m) { m.scene_up = "down"; }},
      {"no file", [](run_config_t& m) { m.scene_file.clear(); }},
      {"no digest", [](run_config_t& m) { m.scene_digest.clear(); }},
  });
}

TEST(Validate, TheFactorsOfThePapersFitness) {
  run_config_t config = example<run_config_t>();
  config.planner.structure_weight = 10.0;
  config.planner.navigation_weight = 0.5;
  EXPECT_EQ(check(config), "");
}

TEST(Validate, EverySensorThereIs) {
  run_config_t config = example<run_config_t>();
  config.sensor.geometry = 1;
  config.sensor.geometry_parameter[0] = 2.0 * std::numbers::pi;
  EXPECT_EQ(check(config), "");
  config.sensor.geometry = 2;
  EXPECT_NE(check(config), "") << "a sweep of a whole turn";
  config.sensor.geometry_parameter[0] = 1.0;
  config.sensor.geometry_parameter[2] = 0.1;
  EXPECT_EQ(check(config), "");
  config.planner.prediction_columns = 64;
  config.planner.prediction_rows = 32;
  EXPECT_EQ(check(config), "");
  range_image_t image = example<range_image_t>();
  for (const int geometry : {0, 1, 2}) {
    image.geometry = static_cast<std::int8_t>(geometry);
    EXPECT_EQ(check(image), "");
  }
}

TEST(Validate, WhatTheSurfaceStrategyReads) {
  const auto refused = [](void (*change)(planner_config_t&)) {
    run_config_t config = example<run_config_t>();
    config.strategy = "surface";
    config.planner.path_cost_per_m = 0.1;
    config.planner.later_departure_m = 0.3;
    config.planner.least_overlap = 0.2;
    config.planner.least_gain_m2 = 0.05;
    config.planner.return_home = 1;
    change(config.planner);
    return !check(config).empty();
  };
  EXPECT_FALSE(refused([](planner_config_t&) {}));
  EXPECT_TRUE(refused([](planner_config_t& m) { m.path_cost_per_m = -0.1; }));
  EXPECT_TRUE(refused([](planner_config_t& m) { m.later_departure_m = kNan; }));
  EXPECT_TRUE(refused([](planner_config_t& m) { m.least_overlap = 1.0; }));
  EXPECT_TRUE(refused([](planner_config_t& m) { m.least_gain_m2 = 0.0; }));
}

}  // namespace
}  // namespace nextview
