// Runs that are killed as a whole, or interrupted, and taken up again.

#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "tests/system/program.h"

namespace nextview {
namespace {

constexpr int kViews = 30;
const std::vector<std::string> kPaper = {"--strategy", "paper", "--no-coverage"};

class ResumedRun : public testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(run_views(folder_ / "undisturbed", kViews, kPaper).status, 0); }

  static std::vector<std::string> resume(const std::filesystem::path& folder,
                                         const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {program_path("nextview_run"), "--resume", folder.string(),
                                          "--no-coverage"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  static void end(Program& run, int view, int signal) {
    ASSERT_TRUE(run.wait_for("view  " + std::string(view < 10 ? " " : "") + std::to_string(view)))
        << run.output();
    run.signal(signal);
    run.wait();
  }
  void expect_the_same_end() {
    EXPECT_EQ(column_of_views(folder_ / "run", "map_digest"),
              column_of_views(folder_ / "undisturbed", "map_digest"));
    const Outcome replay = replay_folder(folder_ / "run", {"--planner"});
    EXPECT_EQ(replay.status, 0) << replay.output;
    for (const char* name :
         {"stop_reason", "views", "map_digest", "path_length_m", "stop_detail"}) {
      const auto expected = summary_of(folder_ / "undisturbed");
      if (!expected.contains(name)) continue;
      EXPECT_EQ(summary_of(folder_ / "run").at(name), expected.at(name)) << name;
    }
  }

  TemporaryFolder folder_;
};

TEST_F(ResumedRun, GoesOnHoweverOftenItIsKilled) {
  {
    Program run(run_arguments(folder_ / "run", kViews, kPaper));
    end(run, 3, SIGKILL);
  }
  for (const int view : {11, 19}) {
    Program run(resume(folder_ / "run"));
    end(run, view, SIGKILL);
  }
  const Outcome last = run_program(resume(folder_ / "run"));
  ASSERT_EQ(last.status, 0) << last.output;
  EXPECT_NE(last.output.find("goes on after view "), std::string::npos) << last.output;
  expect_the_same_end();
}

TEST_F(ResumedRun, GoesOnAfterAnInterruption) {
  Program run(run_arguments(folder_ / "run", kViews, kPaper));
  end(run, 5, SIGINT);
  EXPECT_EQ(summary_of(folder_ / "run").at("stop_reason"), "interrupted");
  const Outcome last = run_program(resume(folder_ / "run"));
  ASSERT_EQ(last.status, 0) << last.output;
  expect_the_same_end();
}

TEST_F(ResumedRun, GoesOnBehindAMessageThatIsCutOff) {
  Program run(run_arguments(folder_ / "run", kViews, kPaper));
  end(run, 8, SIGKILL);
  const auto log = folder_ / "run" / "run.lcmlog";
  run_program({"/usr/bin/env", "flock", (folder_ / "run").string(), "true"});  // its recorder's end
  std::filesystem::resize_file(log, std::filesystem::file_size(log) - 1000);
  const Outcome last = run_program(resume(folder_ / "run"));
  ASSERT_EQ(last.status, 0) << last.output;
  expect_the_same_end();
}

TEST_F(ResumedRun, SaysThatItIsOver) {
  const Outcome again = run_program(resume(folder_ / "undisturbed"));
  EXPECT_EQ(again.status, 0);
  EXPECT_NE(again.output.find("this run has ended, view_limit after 30 views"), std::string::npos)
      << again.output;
}

TEST_F(ResumedRun, GetsItsTablesWhenOnlyTheyAreMissing) {
  const auto summary = summary_of(folder_ / "undisturbed");
  std::filesystem::rename(folder_ / "undisturbed" / "summary.json", folder_ / "summary.json");
  const Outcome again = run_program(resume(folder_ / "undisturbed"));
  EXPECT_EQ(again.status, 0) << again.output;
  EXPECT_EQ(summary_of(folder_ / "undisturbed").at("map_digest"), summary.at("map_digest"));
}

TEST_F(ResumedRun, IsNotAnotherOne) {
  const auto says = [](const std::vector<std::string>& arguments, const std::string& words) {
    const Outcome outcome = run_program(arguments);
    EXPECT_NE(outcome.status, 0) << outcome.output;
    EXPECT_NE(outcome.output.find(words), std::string::npos) << outcome.output;
  };
  says(resume(folder_ / "undisturbed", {"--seed", "2"}), "leave out --seed");
  says(resume(folder_ / "undisturbed", {"columns"}), "leave out SCENE");
  says(resume(folder_ / "nowhere"), "no such folder");
  std::filesystem::create_directory(folder_ / "empty");
  says(resume(folder_ / "empty"), "there is no run.lcmlog");
  std::ofstream(folder_ / "empty" / "run.lcmlog") << "no log";
  says(resume(folder_ / "empty"), "holds no run's configuration");
}

TEST_F(ResumedRun, IsNotOneThatGoesOn) {
  Program run(
      run_arguments(folder_ / "run", 100000, {"--strategy", "paper", "--stop-window", "100000"}));
  ASSERT_TRUE(run.wait_for("view   2/")) << run.output();
  const Outcome outcome = run_program(resume(folder_ / "run"));
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.output.find("another run goes on in it"), std::string::npos) << outcome.output;
  run.signal(SIGTERM);
  EXPECT_EQ(run.wait(), 143) << run.output();
}

}  // namespace
}  // namespace nextview
