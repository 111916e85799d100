#include "runner/run_setup.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>

#include "lcmtypes/validate.h"

namespace nextview {
namespace {

const std::filesystem::path kScenes = std::filesystem::path(NEXTVIEW_SOURCE_DIR) / "scenes";

RunOptions boxes() {
  RunOptions options;
  options.scenes_folder = kScenes.string();
  options.strategy = "paper";
  return options;
}

TEST(RunSetup, LooksForSurfaceUnlessToldOtherwise) {
  RunOptions options;
  options.scenes_folder = kScenes.string();
  const run_config_t config = prepare_run(options).config;
  EXPECT_EQ(check(config), "");
  EXPECT_EQ(config.strategy, "surface");
  EXPECT_EQ(config.planner.max_views, 1000);
  EXPECT_EQ(config.planner.directions, 320);
  EXPECT_GT(config.planner.least_gain_m2, 0.0);
}

TEST(RunSetup, OfThePapersRoomIsThePapers) {
  const RunSetup setup = prepare_run(boxes());
  const run_config_t& config = setup.config;
  EXPECT_EQ(check(config), "");
  EXPECT_TRUE(setup.warnings.empty());
  EXPECT_EQ(config.scene_name, "boxes");
  EXPECT_EQ(config.sensor.columns, 64);
  EXPECT_EQ(config.sensor.rows, 30);
  EXPECT_NEAR(config.sensor.geometry_parameter[1] * 180.0 / std::numbers::pi, 39.07, 0.01);
  EXPECT_EQ(config.map.voxel_size_m, 0.10);
  // Walls at the centres of voxels 0 .. 50, 0 .. 30, 0 .. 30, and one voxel more on every side.
  for (const int min : config.map.window_min) EXPECT_EQ(min, -1);
  EXPECT_EQ(config.map.window_size[0], 53);
  EXPECT_EQ(config.map.window_size[1], 33);
  EXPECT_EQ(config.map.window_size[2], 33);
  EXPECT_EQ(config.planner.max_views, 60);
  EXPECT_EQ(config.planner.quality_weight, 0.0);
  EXPECT_EQ(config.planner.stop_rule, 1);
  EXPECT_NEAR(config.base.lift_max_m, 2.8, 1e-6);
  EXPECT_EQ(config.base.start_m[2], 1.2);
}

TEST(RunSetup, WithQualityTakesMoreViews) {
  RunOptions options = boxes();
  options.quality = true;
  EXPECT_EQ(prepare_run(options).config.planner.max_views, 300);
  options.views = 7;
  EXPECT_EQ(prepare_run(options).config.planner.max_views, 7);
}

TEST(RunSetup, TheCommandLineWinsOverTheScene) {
  RunOptions options = boxes();
  options.start_m = {0.8, 1.1, 1.3};
  options.start_pan_deg = 180.0;
  options.start_tilt_deg = -30.0;
  const run_config_t config = prepare_run(options).config;
  EXPECT_EQ(config.base.start_m[0], 0.8);
  EXPECT_EQ(config.base.start_m[1], 1.1);
  EXPECT_EQ(config.base.start_m[2], 1.3);
  EXPECT_DOUBLE_EQ(config.base.start_pan_rad, std::numbers::pi);
  EXPECT_DOUBLE_EQ(config.base.start_tilt_rad, -std::numbers::pi / 6.0);
}

TEST(RunSetup, LeavesUnitAndAxisToTheFileUnlessTheyAreGiven) {
  RunOptions options;
  options.scene = (kScenes / "boxes" / "boxes.obj").string();
  options.start_m = {0.7, 1.0, 1.2};
  options.unit.emplace("100cm");
  EXPECT_THROW(prepare_run(options), SetupError);
  options.unit.emplace("1.0");
  options.up.emplace("Z");
  const run_config_t config = prepare_run(options).config;
  EXPECT_EQ(config.scene.unit_m, 1.0);
  EXPECT_EQ(config.scene_up, "z");
}

TEST(RunSetup, TakesASensorByNameAndWhatIsSaidOfItBesides) {
  RunOptions options = boxes();
  options.sensor = "panorama";
  options.given_of_sensor.columns = 100;
  options.prediction_rays = "48x16";
  const run_config_t config = prepare_run(options).config;
  EXPECT_EQ(check(config), "");
  EXPECT_EQ(config.sensor.geometry, 1);
  EXPECT_EQ(config.sensor.columns, 100);
  EXPECT_EQ(config.sensor.rows, 250);
  EXPECT_NEAR(config.sensor.geometry_parameter[0], 2.0 * std::numbers::pi, 1e-12);
  EXPECT_EQ(config.planner.prediction_columns, 48);
  EXPECT_EQ(config.planner.prediction_rows, 16);
}

TEST(RunSetup, RefusesSensorsAndRaysThatCannotBe) {
  RunOptions options = boxes();
  options.sensor = "sonar";
  EXPECT_THROW(prepare_run(options), SetupError);
  options.sensor = "paper";
  options.aperture_deg = 90.0;
  EXPECT_THROW(prepare_run(options), SetupError);
  options.aperture_deg = 60.0;
  for (const char* rays : {"64", "64x", "64x1", "64x32x2", "9999x32", "0x0"}) {
    options.prediction_rays = rays;
    EXPECT_THROW(prepare_run(options), SetupError) << rays;
  }
  options.prediction_rays = "64x32";
  EXPECT_NO_THROW(prepare_run(options));
}

TEST(RunSetup, ScoresWhereTheRobotMayBe) {
  const run_config_t config = prepare_run(boxes()).config;
  const ReachParameters reach = visibility_of(config).reach;
  EXPECT_EQ(reach.clearance_m, config.planner.clearance_m);
  EXPECT_EQ(reach.box_min_m.z(), config.base.lift_min_m);
  EXPECT_EQ(reach.box_max_m.z(), config.base.lift_max_m);
  EXPECT_EQ(reach.box_max_m.x(), config.base.workspace_max_m[0]);
}

}  // namespace
}  // namespace nextview
