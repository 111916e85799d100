#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "lcmtypes/bus.h"
#include "logger/run_log.h"
#include "tests/system/program.h"

namespace nextview {
namespace {

/// A run that would go on for long, past its third view.
class LongRun : public testing::Test {
 protected:
  void start(const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"--strategy", "paper", "--stop-window", "100000"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    start_program(run_arguments(folder_ / "run", 100000, arguments));
  }

  void start_program(const std::vector<std::string>& arguments) {
    run_.emplace(arguments);
    ASSERT_TRUE(run_->wait_for("view   3/")) << run_->output();
    children_ = run_->children();
    ASSERT_EQ(children_.size(), 5u) << "four processes and the recorder";
  }

  void expect_nothing_left() {
    for (const pid_t pid : children_) wait_until_gone(pid);
  }

  void expect_readable_log(const std::string& stop_reason) {
    expect_log_replays_with({0}, stop_reason);
  }

  void expect_log_replays_with(const std::set<int>& statuses, const std::string& stop_reason) {
    const Outcome replay = replay_folder(folder_ / "run");
    EXPECT_TRUE(statuses.contains(replay.status)) << replay.status << "\n" << replay.output;
    EXPECT_NE(replay.output.find(stop_reason), std::string::npos) << replay.output;
    EXPECT_GE(views_in(replay.output, std::regex("(\\d+) views replayed")),
              views_in(run_->output(), std::regex("view +(\\d+)/")))
        << "a view that was shown is not in the log";
    EXPECT_EQ(summary_of(folder_ / "run").at("stop_reason"), stop_reason);
  }

  /// The last number of views that a text speaks of.
  static int views_in(const std::string& text, const std::regex& words) {
    int views = 0;
    for (std::sregex_iterator found(text.begin(), text.end(), words), end; found != end; ++found) {
      views = std::stoi((*found)[1]);
    }
    return views;
  }

  TemporaryFolder folder_;
  std::optional<Program> run_;
  std::vector<pid_t> children_;
};

TEST_F(LongRun, EndsCleanlyOnSigint) {
  start();
  run_->signal(SIGINT);
  EXPECT_EQ(run_->wait(), 130) << run_->output();
  expect_nothing_left();
  expect_readable_log("interrupted");
}

TEST_F(LongRun, EndsCleanlyOnSigterm) {
  start();
  run_->signal(SIGTERM);
  EXPECT_EQ(run_->wait(), 143) << run_->output();
  expect_nothing_left();
  expect_readable_log("interrupted");
}

TEST_F(LongRun, EndsCleanlyWhenItsTerminalGoes) {
  start();
  run_->signal(SIGHUP);
  EXPECT_EQ(run_->wait(), 129) << run_->output();
  expect_nothing_left();
  expect_readable_log("interrupted");
}

// A planner that has been ended answers no more for its goals and searches.
TEST_F(LongRun, MakesGoodWhatTheRecorderMissedOfAnEndedPlanner) {
  std::filesystem::create_symlink(program_path("forgetful_recorder"), folder_ / "lcm-logger");
  std::vector<std::string> arguments = {"/usr/bin/env", "PATH=" + folder_.path().string()};
  for (const std::string& argument :
       run_arguments(folder_ / "run", 100000, {"--strategy", "paper", "--stop-window", "100000"})) {
    arguments.push_back(argument);
  }
  start_program(arguments);
  run_->signal(SIGTERM);
  EXPECT_EQ(run_->wait(), 143) << run_->output();
  expect_nothing_left();
  expect_readable_log("interrupted");
}

TEST_F(LongRun, LeavesNothingBehindWhenItIsKilled) {
  start();
  run_->signal(SIGKILL);
  run_->wait();
  expect_nothing_left();
  const Outcome replay = replay_folder(folder_ / "run");
  EXPECT_EQ(replay.status, 3);
  EXPECT_NE(replay.output.find("the log lacks NEXTVIEW_STOP"), std::string::npos) << replay.output;
}

// Halted after the last view has been asked for, so that the planner ends the run as it should.
TEST_F(LongRun, DoesNotWaitForEverForARecorderThatIsHalted) {
  start_program(run_arguments(
      folder_ / "run", 400, {"--strategy", "paper", "--stop-window", "100000", "--patience", "3"}));
  const pid_t recorder = run_->child("lcm-logger");
  ASSERT_NE(recorder, 0);
  ::kill(recorder, SIGSTOP);
  EXPECT_EQ(run_->wait(), 5) << run_->output();
  EXPECT_NE(run_->output().find("view 400/400"), std::string::npos) << run_->output();
  EXPECT_NE(run_->output().find("the log still lacks NEXTVIEW_"), std::string::npos)
      << run_->output();
  expect_nothing_left();
  EXPECT_EQ(summary_of(folder_ / "run").at("stop_reason"), "no_answer");
  EXPECT_EQ(summary_of(folder_ / "run").at("views"), 400);
}

TEST_F(LongRun, SaysWhomItWaitsFor) {
  struct Case {
    std::string role;
    std::string words;
  };
  for (const Case& silent :
       {Case{"base_sim", "base_sim did not answer the goal"},
        Case{"sensor_sim", "sensor_sim sent no range image"},
        Case{"mapper", "the mapper did not commit"}, Case{"planner", "the planner gave no goal"}}) {
    start({"--patience", "1"});
    ASSERT_NE(run_->child(silent.role), 0) << silent.role;
    ::kill(run_->child(silent.role), SIGSTOP);
    EXPECT_EQ(run_->wait(), 5) << run_->output();
    EXPECT_NE(run_->output().find(silent.words), std::string::npos) << run_->output();
    expect_nothing_left();
    // What the recorder has missed nobody but the halted process could publish again: then the
    // replay agrees with what is there, and says what is missing.
    expect_log_replays_with({0, 3}, "no_answer");
    std::filesystem::remove_all(folder_ / "run");
  }
}

// A stop of another version's planner, as far as the run can tell.
TEST_F(LongRun, NamesAReasonToStopThatItDoesNotKnow) {
  start({"--verbose", "--no-private"});
  std::smatch bus;
  ASSERT_TRUE(std::regex_search(run_->output(), bus, std::regex("bus: (\\S+), run (\\d+)")))
      << run_->output();
  const std::string lcm_url = bus[1];
  const std::int64_t number = std::stoll(bus[2]);
  // An end counts between two views only, and of the views there are.
  ::kill(run_->child("planner"), SIGSTOP);
  RunLog log(folder_ / "run" / "run.lcmlog", number, RangeImages::OnlyCount);
  int quiet = 0;
  for (int views = 0; quiet < 40; ::poll(nullptr, 0, 5)) {
    log.read_on();
    const RunRecord& record = log.record();
    const bool same = record.committed_views() == views && record.latest_view() == views;
    quiet = same ? quiet + 1 : 0;
    views = record.committed_views();
  }
  Bus other_planner(lcm_url, number, "planner");
  stop_t stop{};
  stop.run = number;
  stop.views = log.record().committed_views();
  stop.stop_reason = "bored";
  stop.detail = "Nothing on.";
  other_planner.publish(stop);
  EXPECT_EQ(run_->wait(), 1) << run_->output();
  EXPECT_NE(run_->output().find("the reason \"bored\", which this version"), std::string::npos)
      << run_->output();
  expect_nothing_left();
  EXPECT_EQ(summary_of(folder_ / "run").at("stop_reason"), "bored");
}

/// Seconds of CPU time a process has used, or nothing when there is none any more.
std::optional<double> cpu_s(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(file, text);
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) return std::nullopt;
  std::istringstream fields(text.substr(name_end + 1));
  std::string skipped;
  for (int i = 0; i < 11; ++i) fields >> skipped;
  double ticks = 0.0;
  fields >> ticks;
  return ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

/// The process that reads the CAD file for another one, if there is one yet.
std::optional<pid_t> child_of(pid_t pid) {
  const std::string of_its_main_thread =
      "/proc/" + std::to_string(pid) + "/task/" + std::to_string(pid);
  std::ifstream file(of_its_main_thread + "/children");
  pid_t child = 0;
  if (!(file >> child)) return std::nullopt;
  return child;
}

TEST(Loading, IsEndedBySigint) {
  const TemporaryFolder folder;
  // assimp reads it for ever.
  std::ofstream(folder / "endless.ply") << "ply\nformat ascii 1.0\nelement face\n";
  Program run(run_arguments(folder / "run", 2,
                            {(folder / "endless.ply").string(), "--start", "1", "1", "1"}));
  std::optional<pid_t> reader;
  while (!(reader = child_of(run.pid())) && cpu_s(run.pid())) ::poll(nullptr, 0, 5);
  ASSERT_TRUE(reader) << "nobody reads the file";
  for (auto used_s = cpu_s(*reader); used_s && *used_s < 0.3; used_s = cpu_s(*reader)) {
    ::poll(nullptr, 0, 5);
  }
  ASSERT_TRUE(cpu_s(*reader)) << "the file does not hold up the reader any more";
  run.signal(SIGINT);
  EXPECT_EQ(run.wait(), 128) << "not ended by the signal";
  EXPECT_FALSE(std::filesystem::exists(folder / "run"));
}

}  // namespace
}  // namespace nextview
