#include "runner/run_setup.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>

#include "lcmtypes/validate.h"
#include "runner/bound_command.h"
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

// In voxels, rounded up, and no more than the map has.
TEST(RunSetup, TellsTheMapperOfItsWindow) {
  RunOptions options = boxes();
  EXPECT_TRUE(prepare_run(options).mapper_options.empty());
  options.window_m = {1.6, 1.61, 100.0};
  const RunSetup setup = prepare_run(options);
  EXPECT_EQ(setup.mapper_options, (std::vector<std::string>{"--window", "16", "17", "33"}));
  options.voxel_size_m = 0.05;
  EXPECT_EQ(prepare_run(options).mapper_options[1], "32");
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

TEST(RunSetup, AStopRuleIsGivenByName) {
  RunOptions options = boxes();
  options.quality = true;
  EXPECT_EQ(prepare_run(options).config.planner.stop_rule, 2);
  int number = 0;
  for (const char* name : {"nothing_new", "quality", "no_improvement"}) {
    options.stop_rule = name;
    const run_config_t config = prepare_run(options).config;
    EXPECT_EQ(config.planner.stop_rule, ++number);
    EXPECT_EQ(config.planner.quality_weight, 1.0);
    EXPECT_EQ(check(config), "");
  }
  options.stop_rule = "boredom";
  EXPECT_THROW(prepare_run(options), SetupError);
}

TEST(RunSetup, AStopRuleIsNotIgnored) {
  RunOptions options = boxes();
  options.strategy = "surface";
  options.stop_rule = "nothing_new";
  EXPECT_THROW(prepare_run(options), SetupError);
  options.planner = "/a/planner/of/ones/own";
  EXPECT_EQ(prepare_run(options).config.planner.stop_rule, 1);
}

TEST(RunSetup, TidyingUpTakesThePapersOrientationsAndEndsByItself) {
  RunOptions options = boxes();
  options.strategy = "paper_tidy_up";
  const run_config_t config = prepare_run(options).config;
  EXPECT_EQ(check(config), "");
  EXPECT_EQ(config.planner.directions, 20);
  EXPECT_EQ(config.planner.max_views, 1000);
}

TEST(RunSetup, WeighsStructureAndNavigationInThePapersFitnessOnly) {
  RunOptions options = boxes();
  options.structure_weight = 2.0;
  options.navigation_weight = 0.5;
  const run_config_t config = prepare_run(options).config;
  EXPECT_EQ(config.planner.structure_weight, 2.0);
  EXPECT_EQ(config.planner.navigation_weight, 0.5);
  options.strategy = "surface";
  for (double* weight : {&options.structure_weight, &options.navigation_weight}) {
    *weight = 0.0;
    try {
      prepare_run(options);
      FAIL() << "the other weight was ignored";
    } catch (const SetupError& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find("--structure-weight and --navigation-weight"), std::string::npos) << text;
      EXPECT_NE(text.find("--strategy paper"), std::string::npos) << text;
    }
    *weight = 1.0;
  }
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

/// A room of which nothing says where to start.
RunOptions room() {
  RunOptions options = boxes();
  options.scene = std::string(NEXTVIEW_SOURCE_DIR) + "/tests/scene/data/room.obj";
  options.clearance_m = 0.3;
  return options;
}

TEST(RunSetup, FindsAStartAndSaysWhich) {
  RunOptions options = room();
  options.start_auto = true;
  const RunSetup setup = prepare_run(options);
  const Eigen::Vector3d start_m(setup.config.base.start_m);
  EXPECT_NEAR(start_m.z(), 1.2, 1e-9);
  ASSERT_FALSE(setup.notes.empty());
  EXPECT_EQ(setup.notes.front().find("starts where it sees most: --start "), 0U)
      << setup.notes.front();
}

TEST(RunSetup, NamesStartsThatWouldDo) {
  try {
    prepare_run(room());
    FAIL() << "a start from nowhere";
  } catch (const SetupError& error) {
    const std::string text = error.what();
    const std::size_t named = text.find("--start ");
    ASSERT_NE(named, std::string::npos) << text;
    EXPECT_NE(text.find("--start auto takes the first"), std::string::npos) << text;
    RunOptions options = room();
    std::istringstream numbers(text.substr(named + 8));
    options.start_m.resize(3);
    for (double& number : options.start_m) ASSERT_TRUE(numbers >> number) << text;
    EXPECT_NO_THROW(prepare_run(options));
  }
}

TEST(RunSetup, SaysWhenThereIsNowhereToStart) {
  RunOptions options = room();
  options.start_auto = true;
  options.clearance_m = 1.9;
  EXPECT_THROW(prepare_run(options), SetupError);
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

// A room of 4 x 4 x 3 m on a footing 1.5 m deep, as an OBJ file.
std::string room_on_a_footing() {
  const auto file = std::filesystem::path(::testing::TempDir()) /
                    (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) +
                     "-room_on_a_footing.obj");
  std::ofstream obj(file);
  int vertices = 0;
  const auto box = [&](double x0, double y0, double z0, double x1, double y1, double z1) {
    for (int corner = 0; corner < 8; ++corner) {
      obj << "v " << ((corner & 1) != 0 ? x1 : x0) << ' ' << ((corner & 2) != 0 ? y1 : y0) << ' '
          << ((corner & 4) != 0 ? z1 : z0) << '\n';
    }
    for (const auto& face : {"1 2 4 3", "5 6 8 7", "1 2 6 5", "3 4 8 7", "1 3 7 5", "2 4 8 6"}) {
      std::istringstream corners(face);
      obj << 'f';
      for (int corner = 0; corners >> corner;) obj << ' ' << vertices + corner;
      obj << '\n';
    }
    vertices += 8;
  };
  box(0.0, 0.0, 0.0, 4.0, 4.0, 3.0);
  box(1.5, 1.5, -1.55, 2.5, 2.5, 0.0);
  return file.string();
}

RunOptions in_room_on_a_footing() {
  RunOptions options;
  options.scene = room_on_a_footing();
  options.unit.emplace("m");
  options.up.emplace("z");
  options.start_m = {0.8, 0.8, 1.2};
  return options;
}

// A footing is not what the robot stands on.
TEST(RunSetup, TakesTheLiftFromTheFloorUnderTheStart) {
  const RunSetup setup = prepare_run(in_room_on_a_footing());
  EXPECT_NEAR(setup.config.base.lift_min_m, 0.2, 1e-6);
  EXPECT_NEAR(setup.config.base.lift_max_m, 2.8, 1e-6);
  EXPECT_NEAR(setup.config.base.workspace_min_m[2], -1.55, 1e-6);
  ASSERT_EQ(setup.notes.size(), 1U);
  EXPECT_NE(setup.notes[0].find("0.20 to 2.80 m (--lift-min, --lift-max)"), std::string::npos)
      << setup.notes[0];
  RunOptions higher = in_room_on_a_footing();
  higher.lift_min_m = 1.0;
  higher.lift_max_m = 2.5;
  EXPECT_EQ(prepare_run(higher).config.base.lift_min_m, 1.0);
  EXPECT_EQ(prepare_run(higher).config.base.lift_max_m, 2.5);
}

TEST(RunSetup, NamesTheLiftWhenTheStartIsBeyondIt) {
  for (const double height_m : {1.2, 0.1}) {
    RunOptions options = in_room_on_a_footing();
    options.start_m[2] = height_m;
    if (height_m > 1.0) options.lift_min_m = 1.5;
    try {
      prepare_run(options);
      FAIL() << "no error at " << height_m;
    } catch (const SetupError& error) {
      const std::string message = error.what();
      for (const char* part : {"--start", "--lift-min", "--lift-max", "floor", "0.00 m"}) {
        EXPECT_NE(message.find(part), std::string::npos) << message;
      }
    }
  }
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

TEST(BoundCommand, IsWhatHasBeenTypedWithoutTheFolder) {
  const auto command_of = [](std::vector<std::string> arguments) {
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    return bound_command_for(static_cast<int>(argv.size()), argv.data());
  };
  EXPECT_EQ(command_of({"bin/nextview_run"}), "bin/nextview_bound");
  EXPECT_EQ(command_of({"/b/nextview_run", "boxes", "--out", "/tmp/x", "--seed", "2"}),
            "/b/nextview_bound boxes --seed 2");
  EXPECT_EQ(command_of({"nextview_run", "--out=/tmp/x", "my flat.obj", "--start", "1", "-2", "1"}),
            "nextview_bound 'my flat.obj' --start 1 -2 1");
  EXPECT_EQ(
      command_of({"nextview_run", "boxes", "--view", "--paused", "--real-time=8", "--seed=2"}),
      "nextview_bound boxes --seed=2");
  EXPECT_EQ(command_of({"nextview_run", "--no-private", "--key-file", "k", "--lcm-url=u",
                        "--seed=2", "--no-coverage", "--patience", "9"}),
            "nextview_bound --seed=2");
  EXPECT_EQ(command_of({"nextview_run", "it's.obj"}), "nextview_bound 'it'\\''s.obj'");
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
    EXPECT_NE(std::string(error.what()).find("--start 50010"), std::string::npos) << error.what();
  }
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace nextview
