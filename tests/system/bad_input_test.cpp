#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "tests/system/program.h"

namespace nextview {
namespace {

/// A run that must refuse to start, in one line that contains the words.
void expect_refusal(const std::vector<std::string>& arguments, const std::string& words) {
  const TemporaryFolder folder;
  const Outcome outcome = run_views(folder / "run", 2, arguments);
  EXPECT_NE(outcome.status, 0) << outcome.output;
  EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
  EXPECT_NE(outcome.output.find(words), std::string::npos) << outcome.output;
}

/// CLI11 adds a line that points to --help.
void expect_wrong_command_line(const std::vector<std::string>& arguments,
                               const std::string& words) {
  const TemporaryFolder folder;
  const Outcome outcome = run_views(folder / "run", 2, arguments);
  EXPECT_GT(outcome.status, 100) << outcome.output;
  EXPECT_NE(outcome.output.find(words), std::string::npos) << outcome.output;
}

class BadScene : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  /// A closed cube of 3 m with a corner at the origin, one face left out if wanted.
  std::string write_cube(bool open) {
    std::string text =
        "v 0 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\nv 0 0 3\nv 3 0 3\nv 3 3 3\nv 0 3 3\n"
        "f 1 2 3 4\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    if (!open) text += "f 5 6 7 8\n";
    return write(open ? "open.obj" : "closed.obj", text);
  }

  TemporaryFolder folder_;
};

TEST_F(BadScene, ThatIsNotThere) {
  expect_refusal({"no_such_scene"}, "no_such_scene");
  expect_refusal({(folder_ / "missing.ply").string(), "--start", "1", "1", "1"}, "missing.ply");
}

TEST_F(BadScene, ThatIsNoCadFile) {
  expect_refusal({write("letter.txt", "Dear reader"), "--start", "1", "1", "1"}, "letter.txt");
  expect_refusal({write("broken.ply", "ply\nformat nonsense\n"), "--start", "1", "1", "1"},
                 "broken.ply");
}

TEST_F(BadScene, WithoutTriangles) {
  const std::string file = write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\np 1 2 3\n");
  expect_refusal({file, "--start", "1", "1", "1"}, "points.obj");
}

TEST_F(BadScene, WithVerticesThatAreNotFinite) {
  const std::string file =
      write("nan.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
            "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
            "end_header\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n");
  expect_refusal({file, "--start", "1", "1", "1"}, "nan.ply");
}

TEST_F(BadScene, ThatSaysNoStart) { expect_refusal({write_cube(false)}, "--start"); }

TEST_F(BadScene, ThatIsLargerThanAMap) {
  const std::string file = write_cube(false);
  expect_refusal({file, "--unit", "1000", "--start", "1500", "1500", "2"}, "--voxel-size");
}

TEST_F(BadScene, ThatIsOpenIsWarnedOf) {
  const Outcome outcome =
      run_views(folder_ / "open", 2, {write_cube(true), "--start", "1.5", "1.5", "1.5"});
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  // From the middle of a cube a sixth of all directions goes through each face.
  const std::size_t at = outcome.output.find("warning: ");
  ASSERT_NE(at, std::string::npos) << outcome.output;
  EXPECT_NEAR(std::stod(outcome.output.substr(at + 9)), 100.0 / 6.0, 0.5) << outcome.output;
  const Outcome closed =
      run_views(folder_ / "closed", 2, {write_cube(false), "--start", "1.5", "1.5", "1.5"});
  EXPECT_EQ(closed.output.find("warning"), std::string::npos) << closed.output;
}

TEST_F(BadScene, WithTheRightUnitAndAxisIsNoneAtAll) {
  const Outcome outcome = run_views(
      folder_ / "run", 2,
      {write_cube(false), "--unit", "2", "--up", "y", "--start", "3", "-3", "2", "--verbose"});
  EXPECT_EQ(outcome.status, 0) << outcome.output;
}

TEST(BadStart, InsideAnObstacle) {
  // The boxes room's own boxes: one stands somewhere on the floor; below the floor nothing is.
  expect_refusal({"--start", "1", "1", "-1"}, "--start");
}

TEST(BadStart, TooNearAWall) { expect_refusal({"--start", "0.1", "1.0", "1.2"}, "--start"); }

TEST(BadStart, NearerThanTheClearance) {
  expect_refusal({"--start", "0.3", "1.0", "1.2"}, "--clearance");
}

TEST(BadStart, OutsideTheScene) { expect_refusal({"--start", "9", "9", "1.2"}, "--start"); }

TEST(BadOption, IsNamed) {
  expect_wrong_command_line({"--voxel-size", "nan"}, "--voxel-size");
  expect_wrong_command_line({"--voxel-size", "-0.1"}, "--voxel-size");
  expect_wrong_command_line({"--range-noise-m", "inf"}, "--range-noise-m");
  expect_wrong_command_line({"--seed", "seven"}, "--seed");
  expect_wrong_command_line({"--start", "1", "2"}, "--start");
  expect_wrong_command_line({"--max-evaluations", "3"}, "--max-evaluations");
  expect_wrong_command_line({"--quality-threshold", "1.5"}, "--quality-threshold");
  expect_wrong_command_line({"--no-such-option"}, "--no-such-option");
  expect_wrong_command_line({"--sed", "3"}, "did you mean --seed?");
  expect_wrong_command_line({"--stratgy=paper"}, "did you mean --strategy?");
}

TEST(BadOption, ThatContradictsAnotherIsNamed) {
  expect_refusal({"--range-min", "5", "--range-max", "4"}, "--range-min");
  expect_refusal({"--step-min", "2", "--step-max", "1"}, "--step-min");
  expect_refusal({"--lift-min", "2", "--lift-max", "1"}, "--lift-min");
  expect_refusal({"--unit", "parsec"}, "--unit");
  expect_refusal({"--up", "w"}, "--up");
}

TEST(BadOption, LcmUrlIsNamed) {
  const TemporaryFolder folder;
  const Outcome outcome = run_views(folder / "run", 2, {"--lcm-url", "nonsense"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.output.find("LCM URL 'nonsense'"), std::string::npos) << outcome.output;
  EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
}

TEST(BadOption, OutThatHoldsARunIsLeftAlone) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_views(folder / "run", 1).status, 0);
  const auto before = std::filesystem::last_write_time(folder / "run" / "run.lcmlog");
  const Outcome outcome = run_views(folder / "run", 1);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.output.find("--out"), std::string::npos) << outcome.output;
  EXPECT_EQ(std::filesystem::last_write_time(folder / "run" / "run.lcmlog"), before);
}

/// What a program says and does that is started by a line of the shell, "$@" its arguments.
Outcome run_by_shell(const std::string& line, const std::vector<std::string>& arguments) {
  std::vector<std::string> all = {"/usr/bin/env", "bash", "-c", line, "bash"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return run_program(all);
}

TEST(BadMachine, TooFewOpenFilesAreNamed) {
  const TemporaryFolder folder;
  const std::vector<std::string> run = run_arguments(folder / "run", 1);
  for (const std::vector<std::string>& arguments :
       {run, std::vector<std::string>{program_path("nextview_mapper"), "--run", "1"}}) {
    for (const char* limit : {"8", "16"}) {
      const Outcome outcome =
          run_by_shell(std::string("ulimit -n ") + limit + "; exec \"$@\"", arguments);
      EXPECT_EQ(outcome.status, 1) << outcome.output;
      EXPECT_NE(outcome.output.find("type, in a new shell or as root: ulimit -n 1024\n"),
                std::string::npos)
          << outcome.output;
      EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1)
          << outcome.output;
    }
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "run"));
  // Where the system allows more, that is taken.
  const Outcome allowed = run_by_shell("ulimit -S -n 16; exec \"$@\"", run);
  EXPECT_EQ(allowed.status, 0) << allowed.output;
}

TEST(BadMachine, AFullOutputIsNoSuccess) {
  const TemporaryFolder folder;
  const std::string into_full = "exec \"$@\" > /dev/full";
  const Outcome run = run_by_shell(into_full, run_arguments(folder / "run", 1));
  EXPECT_EQ(run.status, 1) << run.output;
  EXPECT_NE(run.output.find("could not be written to standard output"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder / "run" / "summary.json"));
  const std::vector<std::string> replay = {program_path("nextview_replay"),
                                           (folder / "run").string()};
  EXPECT_EQ(run_by_shell(into_full, replay).status, 1);
  // Whoever has read enough may go.
  const Outcome gone = run_by_shell("set -o pipefail; \"$@\" | true", replay);
  EXPECT_EQ(gone.output, "");
}

TEST(Help, IsPrinted) {
  for (const char* name : {"nextview_run", "nextview_replay", "nextview_sensor_sim",
                           "nextview_base_sim", "nextview_mapper", "nextview_planner"}) {
    const Outcome outcome = run_program({program_path(name), "--help"});
    EXPECT_EQ(outcome.status, 0) << name;
    EXPECT_GT(outcome.output.size(), 300u) << outcome.output;
  }
}

}  // namespace
}  // namespace nextview
