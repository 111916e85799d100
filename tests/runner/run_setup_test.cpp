#include "runner/run_setup.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <numbers>

#include "lcmtypes/validate.h"
#include "tests/scene/far_boxes.h"

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

TEST(RunSetup, ScoresWhereTheRobotMayBe) {
  const run_config_t config = prepare_run(boxes()).config;
  const ReachParameters reach = visibility_of(config).reach;
  EXPECT_EQ(reach.clearance_m, config.planner.clearance_m);
  EXPECT_EQ(reach.box_min_m.z(), config.base.lift_min_m);
  EXPECT_EQ(reach.box_max_m.z(), config.base.lift_max_m);
  EXPECT_EQ(reach.box_max_m.x(), config.base.workspace_max_m[0]);
}

/// Where the paper's room would be on a map of the country.
TEST(RunSetup, TakesTheStartOfAGeoreferencedSceneInTheFilesCoordinates) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() /
      ("nextview-georeferenced-" + std::to_string(::getpid()) + ".obj");
  write_far_boxes(file, 500e3 + 100.0, 5400e3);
  RunOptions options = boxes();
  options.scene = file.string();
  options.start_m = {500100.7, 5400001.0, 1.2};
  const RunSetup setup = prepare_run(options);
  EXPECT_EQ(check(setup.config), "");
  EXPECT_EQ(setup.config.scene.origin_in_file_m[0], 500e3);
  EXPECT_EQ(setup.config.scene.origin_in_file_m[1], 5400e3);
  EXPECT_EQ(setup.config.scene.origin_in_file_m[2], 0.0);
  EXPECT_NEAR(setup.config.base.start_m[0], 100.7, 1e-9);
  EXPECT_NEAR(setup.config.base.start_m[1], 1.0, 1e-9);
  EXPECT_EQ(setup.config.map.window_min[0], 999);
  EXPECT_EQ(setup.config.map.window_size[0], 53);
  ASSERT_EQ(setup.warnings.size(), 1U);
  EXPECT_NE(setup.warnings[0].find("(500000.00, 5400000.00, 0.00) m"), std::string::npos)
      << setup.warnings[0];

  options.start_m.clear();
  try {
    prepare_run(options);
    ADD_FAILURE() << "a start was made up";
  } catch (const SetupError& error) {
    EXPECT_NE(std::string(error.what()).find("(500100.00 .. 500105.00, 5400000.00 .."),
              std::string::npos)
        << error.what();
  }
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace nextview
