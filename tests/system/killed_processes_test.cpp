// Processes of a run that are killed in its midst: others stand in for them, and the run ends as if
// nothing had been.

#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>

#include <optional>
#include <random>

#include "runner/restart_limit.h"
#include "tests/system/program.h"

namespace nextview {
namespace {

constexpr int kViews = 30;
const std::vector<std::string> kPaper = {"--strategy", "paper", "--no-coverage"};

class KilledProcesses : public testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(run_views(folder_ / "undisturbed", kViews, kPaper).status, 0); }

  void start(int views = kViews, const std::vector<std::string>& more = kPaper) {
    std::filesystem::remove_all(folder_ / "run");
    run_.emplace(run_arguments(folder_ / "run", views, more));
  }
  /// Kills a process of the run as soon as there is one; false when the run ends without.
  bool kill(const std::string& role) {
    pid_t victim = 0;
    while ((victim = run_->child(role)) == 0 || victim == killed_) {
      if (!run_->running()) return false;
      ::poll(nullptr, 0, 1);
    }
    ::kill(victim, SIGKILL);
    killed_ = victim;
    return true;
  }
  bool says(const std::string& words) const {
    return run_->output().find(words) != std::string::npos;
  }
  void expect_the_same_end() {
    ASSERT_EQ(run_->wait(), 0) << run_->output();
    EXPECT_EQ(column_of_views(folder_ / "run", "map_digest"),
              column_of_views(folder_ / "undisturbed", "map_digest"));
    const Outcome replay = replay_folder(folder_ / "run", {"--planner"});
    EXPECT_EQ(replay.status, 0) << replay.output << run_->output();
  }

  TemporaryFolder folder_;
  std::optional<Program> run_;
  pid_t killed_ = 0;
};

TEST_F(KilledProcesses, AreStoodInFor) {
  std::mt19937 dice(11);
  for (const std::string role : {"base_sim", "sensor_sim", "mapper", "planner", "lcm-logger"}) {
    const auto view = std::uniform_int_distribution<>(1, kViews - 4)(dice);
    SCOPED_TRACE(role + " killed after view " + std::to_string(view));
    start();
    ASSERT_TRUE(run_->wait_for("view  " + std::string(view < 10 ? " " : "") + std::to_string(view)))
        << run_->output();
    ASSERT_TRUE(kill(role)) << run_->output();
    expect_the_same_end();
    EXPECT_TRUE(says(role + " was killed by signal 9 (Killed)")) << run_->output();
  }
}

TEST_F(KilledProcesses, AreStoodInForBeforeTheFirstView) {
  for (const std::string role : {"base_sim", "sensor_sim", "mapper", "lcm-logger", "planner"}) {
    SCOPED_TRACE(role);
    start();
    ASSERT_TRUE(kill(role));
    expect_the_same_end();
  }
}

TEST_F(KilledProcesses, AreStoodInForWhenAllAreKilledAtOnce) {
  start();
  ASSERT_TRUE(run_->wait_for("view  12/")) << run_->output();
  const std::vector<pid_t> all = run_->children();
  EXPECT_EQ(all.size(), 5U);
  for (const pid_t pid : all) ::kill(pid, SIGKILL);
  expect_the_same_end();
}

TEST_F(KilledProcesses, ThatKeepDyingEndTheRunByName) {
  for (const std::string role : {"mapper", "planner", "lcm-logger"}) {
    SCOPED_TRACE(role);
    start(100000, {"--strategy", "paper", "--stop-window", "100000"});
    int kills = 0;
    while (kill(role)) ++kills;
    EXPECT_EQ(run_->wait(), 6) << run_->output();
    EXPECT_GT(kills, RestartLimit::kTries) << run_->output();
    EXPECT_TRUE(says("nextview_run: process_died: " + role + " was killed by signal 9 (Killed)"))
        << run_->output();
    EXPECT_TRUE(says("started again 3 times, and did not get on")) << run_->output();
  }
}

TEST_F(KilledProcesses, ThatAreTheUsersOwnPlannersAreNotStoodInFor) {
  start(2, {"--planner", "/bin/false"});
  EXPECT_EQ(run_->wait(), 6) << run_->output();
  EXPECT_TRUE(says("planner ended with status 1")) << run_->output();
  EXPECT_TRUE(says("A planner of your own is not started again")) << run_->output();
}

}  // namespace
}  // namespace nextview
