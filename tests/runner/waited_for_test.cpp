#include "runner/waited_for.h"

#include <gtest/gtest.h>

namespace nextview {
namespace {

const std::vector<std::string> kAll = {"base_sim", "sensor_sim", "mapper"};

/// A run whose processes are ready, in which the planner has given a goal of each view so far.
HeardRun run_at_goal_of(int view) {
  HeardRun heard;
  run_config_t config{};
  config.planner.max_views = 10;
  config.planner.max_attempts = 3;
  heard.record.add(config);
  for (const std::string& role : kAll) heard.statuses[role] = {};
  for (int k = 1; k <= view; ++k) {
    goal_t goal{};
    goal.view = k;
    goal.attempt = 1;
    heard.record.add(goal);
  }
  return heard;
}

arrival_t arrival_at(int view, bool arrived) {
  arrival_t arrival{};
  arrival.view = view;
  arrival.attempt = 1;
  arrival.arrived = arrived;
  return arrival;
}

TEST(WaitedFor, NamesWhoHasNotAskedForTheConfiguration) {
  HeardRun heard;
  EXPECT_EQ(waited_for(heard, kAll), "nothing was heard of base_sim, sensor_sim, mapper");
  heard.asked_for_config = {"sensor_sim", "viewer"};
  EXPECT_EQ(waited_for(heard, kAll), "nothing was heard of base_sim, mapper");
  heard.asked_for_config = {"base_sim", "sensor_sim", "mapper"};
  EXPECT_EQ(waited_for(heard, kAll), "nothing was heard of lcm-logger, which has recorded nothing");
}

TEST(WaitedFor, NamesWhoIsNotReady) {
  HeardRun heard = run_at_goal_of(0);
  heard.statuses.erase("sensor_sim");
  EXPECT_EQ(waited_for(heard, kAll), "sensor_sim did not get ready");
}

TEST(WaitedFor, FollowsAViewFromGoalToCommit) {
  HeardRun heard = run_at_goal_of(0);
  EXPECT_EQ(waited_for(heard, kAll), "the planner gave no goal after view 0");
  heard = run_at_goal_of(2);
  EXPECT_EQ(waited_for(heard, kAll), "base_sim did not answer the goal of view 2");
  EXPECT_EQ(waited_for(heard, {"mapper"}),
            "the driver in place of base_sim did not answer the goal of view 2");
  heard.record.add(arrival_at(2, true));
  EXPECT_EQ(waited_for(heard, kAll), "sensor_sim sent no range image of view 2");
  EXPECT_EQ(waited_for(heard, {"base_sim", "mapper"}),
            "the driver in place of sensor_sim sent no range image of view 2");
  commit_t commit{};
  commit.view = 2;
  commit.attempt = 1;
  heard.record.add(commit);
  EXPECT_EQ(waited_for(heard, kAll), "the planner gave no goal after view 2");
}

TEST(WaitedFor, ARefusedGoalIsThePlannersAgain) {
  HeardRun heard = run_at_goal_of(2);
  heard.record.add(arrival_at(2, false));
  EXPECT_EQ(waited_for(heard, kAll), "the planner gave no goal after view 2");
}

TEST(HeardRun, IsPausedBetweenViewsOnly) {
  HeardRun heard = run_at_goal_of(0);
  EXPECT_FALSE(heard.paused());
  pace_t pace{};
  pace.holds_s = 60.0;
  heard.pace.hear(pace, HeardRun::Clock::now());
  EXPECT_TRUE(heard.paused()) << "before view 1";
  pace.pace_number = 1;
  pace.last_view = 1;
  heard.pace.hear(pace, HeardRun::Clock::now());
  EXPECT_FALSE(heard.paused()) << "view 1 may come";
  goal_t goal{};
  goal.view = 1;
  goal.attempt = 1;
  heard.record.add(goal);
  EXPECT_FALSE(heard.paused()) << "somebody works on view 1, and is waited for";
  commit_t commit{};
  commit.view = 1;
  commit.attempt = 1;
  heard.record.add(commit);
  EXPECT_TRUE(heard.paused());
  heard.pace.hear(pace, HeardRun::Clock::now() - std::chrono::seconds(61));
  EXPECT_FALSE(heard.paused()) << "nothing was heard of the viewer for a minute";
}

// By the clock, of a run that is paced to be watched.
TEST(WatchedMotion, TakesAsLongAsItsGoalAndAScan) {
  HeardRun heard = run_at_goal_of(1);
  goal_t goal{};
  goal.view = 2;
  goal.attempt = 1;
  goal.path_length_m = 30.0;
  run_config_t config{};
  config.base.base_speed_m_s = 0.5;
  config.base.lift_speed_m_s = 1.0;
  config.base.turn_speed_rad_s = 10.0;
  config.sensor.scan_duration_s = 2.0;
  heard.record.add(goal);
  EXPECT_DOUBLE_EQ(watched_motion_s(heard.record, config, 1.0), 62.0);
  EXPECT_DOUBLE_EQ(watched_motion_s(heard.record, config, 4.0), 15.5);
  EXPECT_EQ(watched_motion_s(heard.record, config, 0.0), 0.0) << "not paced";
  EXPECT_EQ(watched_motion_s(run_at_goal_of(0).record, config, 1.0), 0.0) << "nothing is under way";
}

}  // namespace
}  // namespace nextview
