// The planner on a bus without faults, with a base that refuses some goals and a mapper that may
// lie: what it publishes, when, and on what.

#include "planner/planner_process.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "mapper/mapper_config.h"
#include "mapper/mapper_process.h"
#include "planner/planner_config.h"
#include "sensor_sim/sensor_sim_process.h"
#include "tests/lcmtypes/lossy_network.h"
#include "tests/planner/boxes_run.h"

namespace nextview {
namespace {

using std::chrono::milliseconds;
using Attempt = std::pair<int, int>;  // view and attempt

run_config_t boxes_config() {
  run_config_t config = boxes_run_config();
  config.planner.max_views = 6;
  config.planner.max_attempts = 3;
  return config;
}

class PlannerOnTheBus : public testing::Test {
 protected:
  PlannerOnTheBus() {
    base_bus_.on<goal_t>([this](const goal_t& goal) { arrive(goal); });
    watcher_.on<goal_t>([this](const goal_t& goal) { goals_[{goal.view, goal.attempt}] = goal; });
    watcher_.on<timing_t>([this](const timing_t& timing) {
      const auto names = names_of(timing.duration_names);
      for (std::size_t i = 0; i < names.size(); ++i) {
        durations_s_[{timing.view, timing.attempt, std::string(names[i])}] = timing.duration_s[i];
      }
    });
    watcher_.on<stop_t>([this](const stop_t& stop) { stop_ = stop; });
    watcher_.on<commit_t>([this](const commit_t& commit) { commits_[commit.view] = commit; });
    watcher_.on<range_image_t>([this](const range_image_t& part) {
      if (auto image = assembler_.add(part)) images_.emplace(part.view, std::move(*image));
    });
  }

  void arrive(const goal_t& goal) {
    arrival_t arrival{};
    arrival.utime = goal.utime + 1000;
    arrival.view = goal.view;
    arrival.attempt = goal.attempt;
    arrival.arrived = !refused_.contains({goal.view, goal.attempt});
    if (!arrival.arrived) arrival.refusal = "a chair is in the way";
    for (int axis = 0; axis < 3; ++axis) {
      arrival.true_position_m[axis] = arrival.believed_position_m[axis] = goal.position_m[axis];
    }
    arrival.true_pan_rad = arrival.believed_pan_rad = goal.pan_rad;
    arrival.true_tilt_rad = arrival.believed_tilt_rad = goal.tilt_rad;
    base_bus_.publish(arrival);
  }

  /// One piece of everybody's work, the mapper only when it may; false when all wait.
  bool turn(bool mapper_works) {
    bool worked = planner_.step();
    worked |= sensor_.step();
    if (mapper_works) worked |= mapper_.step();
    for (Bus* bus : {&planner_bus_, &base_bus_, &sensor_bus_, &mapper_bus_, &watcher_}) {
      worked |= bus->handle(milliseconds(0));
    }
    return worked;
  }
  void run() {
    while (turn(true)) {
    }
  }

  run_config_t config_ = boxes_config();
  LossyNetwork network_{{}, 1};
  Bus planner_bus_{network_.connect(), 7, "planner"};
  Bus base_bus_{network_.connect(), 7, "base_sim"};
  Bus sensor_bus_{network_.connect(), 7, "sensor_sim"};
  Bus mapper_bus_{network_.connect(), 7, "mapper"};
  Bus watcher_{network_.connect(), 7, "run"};
  PlannerProcess planner_{planner_bus_, config_};
  SensorSimProcess sensor_{sensor_bus_, config_};
  MapperProcess mapper_{mapper_bus_, config_};
  RangeImageAssembler assembler_;

  std::set<Attempt> refused_;
  std::map<Attempt, goal_t> goals_;
  std::map<int, commit_t> commits_;
  std::map<std::tuple<int, int, std::string>, double> durations_s_;  // by view, attempt and name
  std::map<int, ReceivedRangeImage> images_;
  std::optional<stop_t> stop_;
};

TEST_F(PlannerOnTheBus, GivesNoGoalBeyondAPaceAndTheSameGoalsAfterIt) {
  const auto go_to = [this](std::int64_t number, int view, double holds_s) {
    pace_t pace{};
    pace.pace_number = number;
    pace.last_view = view;
    pace.holds_s = holds_s;
    watcher_.publish(pace);
    while (turn(true)) {
    }
  };
  const auto last_goal = [this] { return goals_.empty() ? 0 : goals_.rbegin()->first.first; };
  constexpr int kAnyView = std::numeric_limits<std::int32_t>::max();
  planner_bus_.handle(milliseconds(0));
  watcher_.publish([] {
    pace_t pace{};
    pace.pace_number = 1;
    pace.holds_s = 60.0;
    return pace;
  }());
  planner_bus_.handle(milliseconds(0));
  run();
  EXPECT_EQ(last_goal(), 0) << "paused before the start";
  go_to(2, 1, 60.0);
  EXPECT_EQ(last_goal(), 1) << "a step";
  const std::size_t said = network_.published().size();
  planner_.ask_again();
  EXPECT_EQ(network_.published().size(), said) << "it waits for nobody's answer";
  go_to(4, 3, 60.0);
  EXPECT_EQ(last_goal(), 3);
  go_to(3, kAnyView, 60.0);
  EXPECT_EQ(last_goal(), 3) << "overtaken by the one before it";
  go_to(5, 3, 0.0);
  EXPECT_EQ(last_goal(), 6) << "a pace that holds no longer";
  ASSERT_TRUE(stop_);
  EXPECT_EQ(stop_->views, 6);

  // The same as of a planner that nobody has paused.
  const std::unique_ptr<ViewPlanner> planner = make_view_planner(config_);
  for (int view = 1; view < 6; ++view) {
    planner->fold(images_.at(view).image);
    const auto& decision = std::get<Decision>(planner->next_view());
    EXPECT_EQ(Eigen::Vector3d(goals_.at({view + 1, 1}).position_m), decision.pose.position_m);
  }
}

TEST_F(PlannerOnTheBus, DecidesAfterRefusalsOnWhatItHasFoldedAndOnThemAlone) {
  refused_ = {{3, 1}, {5, 1}, {5, 2}};
  run();
  ASSERT_TRUE(stop_);
  EXPECT_EQ(stop_->stop_reason, "view_limit");
  EXPECT_EQ(stop_->views, 6);

  const std::unique_ptr<ViewPlanner> planner = make_view_planner(config_);
  std::size_t decided_again = 1;  // the first goal is the start
  for (int view = 1; view <= 6; ++view) {
    for (int attempt = 1; view > 1 && attempt <= commits_.at(view).attempt; ++attempt) {
      if (attempt > 1) planner->refuse();
      ASSERT_TRUE(std::holds_alternative<Decision>(planner->next_view()));
      const auto& decision = std::get<Decision>(planner->next_view());
      const goal_t& goal = goals_.at({view, attempt});
      EXPECT_EQ(Eigen::Vector3d(goal.position_m), decision.pose.position_m)
          << "view " << view << ", attempt " << attempt;
      EXPECT_EQ(goal.pan_rad, decision.pose.pan_rad);
      ++decided_again;
    }
    planner->fold(images_.at(view).image);
  }
  EXPECT_EQ(commits_.at(5).attempt, 3);
  EXPECT_EQ(decided_again, goals_.size());
}

TEST_F(PlannerOnTheBus, PublishesAGoalOnlyOnceTheCommitHasCome) {
  while (turn(false)) {  // until all wait for the mapper
  }
  ASSERT_TRUE(images_.contains(1));
  EXPECT_EQ(goals_.size(), 1U);
  while (mapper_.step() || mapper_bus_.handle(milliseconds(0))) {
  }
  while (!goals_.contains({2, 1})) {
    ASSERT_TRUE(watcher_.handle(milliseconds(0)) || planner_bus_.handle(milliseconds(0)) ||
                planner_.step());
  }
  EXPECT_TRUE(commits_.contains(1));
}

TEST_F(PlannerOnTheBus, SaysHowLongItDecidedFoldedAndWaited) {
  refused_ = {{3, 1}};
  run();
  for (int view = 2; view <= 6; ++view) {
    EXPECT_GT((durations_s_[{view, 1, "plan"}]), 0.0) << view;
    EXPECT_GT((durations_s_[{view, 1, "fold_before"}]), 0.0) << view;
    EXPECT_GT((durations_s_[{view, view == 3 ? 2 : 1, "update"}]), 0.0)
        << "the mapper, view " << view;
  }
  EXPECT_GT((durations_s_[{3, 2, "plan"}]), 0.0) << "after the refusal";
  EXPECT_GT((durations_s_[{7, 0, "fold_before"}]), 0.0) << "of the last view";
  EXPECT_FALSE(durations_s_.contains({7, 0, "plan"}));
}

TEST_F(PlannerOnTheBus, StopsWithoutAnotherGoalWhenTheMapperHasAnotherMap) {
  while (turn(false)) {
  }
  ASSERT_TRUE(images_.contains(1));
  commit_t lie = example<commit_t>();
  lie.view = 1;
  lie.attempt = 1;
  lie.map_digest = std::string(32, '0');
  mapper_bus_.publish(lie);
  while (turn(false)) {
  }
  ASSERT_TRUE(stop_);
  EXPECT_EQ(stop_->stop_reason, "digest_mismatch");
  EXPECT_NE(stop_->detail.find(lie.map_digest), std::string::npos) << stop_->detail;
  EXPECT_EQ(goals_.size(), 1U);
}

TEST_F(PlannerOnTheBus, GivesUpAfterAsManyAttemptsAsItMayMake) {
  refused_ = {{3, 1}, {5, 1}, {5, 2}, {5, 3}};
  ASSERT_EQ(config_.planner.max_attempts, 3);
  run();
  ASSERT_TRUE(stop_);
  EXPECT_EQ(stop_->stop_reason, "no_feasible_goal");
  EXPECT_EQ(stop_->views, 4);
  EXPECT_EQ(stop_->final_attempt, config_.planner.max_attempts);
  EXPECT_NE(stop_->detail.find("a chair is in the way"), std::string::npos) << stop_->detail;
}

}  // namespace
}  // namespace nextview
