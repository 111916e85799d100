#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "runner/run_setup.h"
#include "tests/system/program.h"

namespace nextview {
namespace {

std::string exactly(double value) { return fmt::format("{}", value); }

/// The words that follow a text in what a program says, up to a separator.
std::string after(const std::string& output, const std::string& text, char separator) {
  const std::size_t begin = output.find(text) + text.size();
  return output.substr(begin, output.find(separator, begin) - begin);
}

TEST(OwnRobot, RecoversWhatTheSimulatedOneDoes) {
  constexpr int kViews = 12;
  const TemporaryFolder folder;
  ASSERT_EQ(run_views(folder / "simulated", kViews).status, 0);

  RunOptions options;
  options.scenes_folder = std::string(NEXTVIEW_SOURCE_DIR) + "/scenes";
  const run_config_t simulated = prepare_run(options).config;
  std::vector<std::string> arguments = {"--without", "sensor_sim,base_sim", "--start"};
  for (const double value : simulated.base.start_m) arguments.push_back(exactly(value));
  arguments.emplace_back("--workspace");
  for (const double value : simulated.base.workspace_min_m) arguments.push_back(exactly(value));
  for (const double value : simulated.base.workspace_max_m) arguments.push_back(exactly(value));
  arguments.emplace_back("--start-pan");
  arguments.push_back(exactly(simulated.base.start_pan_rad * 180.0 / std::numbers::pi));
  Program run(run_arguments(folder / "own", kViews, arguments));
  ASSERT_TRUE(run.wait_for(", run ")) << run.output();
  ASSERT_EQ(run.child("sensor_sim"), 0);
  ASSERT_EQ(run.child("base_sim"), 0);
  Program driver({program_path("driver"), after(run.output(), "bus: ", ','),
                  after(run.output(), ", run ", '\n'), simulated.scene_file, "both"});
  ASSERT_EQ(run.wait(), 0) << run.output();

  EXPECT_EQ(column_of_views(folder / "own", "map_digest"),
            column_of_views(folder / "simulated", "map_digest"));
  const Outcome replay = replay_folder(folder / "own", {"--planner"});
  EXPECT_EQ(replay.status, 0) << replay.output;
  const auto summary = summary_of(folder / "own");
  EXPECT_EQ(summary.at("views"), kViews);
  EXPECT_TRUE(summary.at("surface_coverage").is_null());
  EXPECT_EQ(summary.at("surface_coverage_unknown"),
            "there is no CAD model to hold the map against");
  EXPECT_EQ(summary.at("scene_file"), "");
}

// Nothing that it says is quite what the simulator would have said.
TEST(OwnRobot, ThatComputesIn32BitsIsReplayedInThePlaceOfEither) {
  for (const std::string place : {"base_sim", "sensor_sim"}) {
    const TemporaryFolder folder;
    Program run(run_arguments(folder / "run", 4, {"--without", place}));
    ASSERT_TRUE(run.wait_for(", run ")) << run.output();
    Program driver({program_path("driver"), after(run.output(), "bus: ", ','),
                    after(run.output(), ", run ", '\n'),
                    NEXTVIEW_SOURCE_DIR "/scenes/boxes/boxes.obj", place, "float32"});
    ASSERT_EQ(run.wait(), 0) << run.output();
    const Outcome replay = replay_folder(folder / "run", {"--planner"});
    EXPECT_EQ(replay.status, 0) << place << ": " << replay.output;
    EXPECT_NE(replay.output.find("4 views replayed"), std::string::npos) << replay.output;
    EXPECT_NE(replay.output.find("of one's own"), std::string::npos) << replay.output;
  }
}

TEST(OwnRobot, ThatDoesNotAnswerIsNamed) {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_views(folder / "run", 2,
                {"--without", "sensor_sim,base_sim", "--start", "1", "1", "1", "--workspace", "0",
                 "0", "0", "3", "3", "3", "--patience", "1"});
  EXPECT_EQ(outcome.status, 5) << outcome.output;
  EXPECT_NE(
      outcome.output.find("the driver in place of base_sim did not answer the goal of view 1"),
      std::string::npos)
      << outcome.output;
}

TEST(OwnRobot, NeedsAStartInsideAWorkspace) {
  const TemporaryFolder folder;
  const auto says = [&folder](const std::vector<std::string>& more, const std::string& words) {
    std::vector<std::string> arguments = {"--without", "sensor_sim,base_sim"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run_views(folder / "run", 2, arguments);
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    EXPECT_NE(outcome.output.find(words), std::string::npos) << outcome.output;
  };
  const std::vector<std::string> workspace = {"--workspace", "0", "0", "0", "3", "3", "3"};
  const auto with = [&workspace](std::vector<std::string> more) {
    more.insert(more.end(), workspace.begin(), workspace.end());
    return more;
  };
  says({"--start", "1", "1", "1"}, "needs --start X Y Z and --workspace");
  says(workspace, "needs --start X Y Z and --workspace");
  says(with({"--start", "1", "4", "1"}), "--start: outside --workspace");
  says(with({"--start", "1", "1", "2.95"}), "--lift-max");
  says({"--start", "1", "1", "1", "--workspace", "0", "0", "0", "3", "-3", "3"}, "must be below");
  says(with({"boxes", "--start", "1", "1", "1"}), "there is no SCENE");
  const Outcome in_scene = run_program([&] {
    std::vector<std::string> arguments = run_arguments(folder / "run", 2);
    arguments.insert(arguments.end(), workspace.begin(), workspace.end());
    return arguments;
  }());
  EXPECT_EQ(in_scene.status, 1) << in_scene.output;
  EXPECT_NE(in_scene.output.find("a scene has its own"), std::string::npos) << in_scene.output;
}

}  // namespace
}  // namespace nextview
