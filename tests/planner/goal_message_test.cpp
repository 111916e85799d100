#include "planner/goal_message.h"

#include <gtest/gtest.h>

#include "lcmtypes/validate.h"

namespace nextview {
namespace {

Decision decision() {
  Decision decision;
  decision.strategy = "paper";
  decision.waypoints_m = {{0.0, 0.0, 1.0}, {3.0, 0.0, 1.0}, {3.0, 4.0, 1.0}};
  decision.pose.position_m = decision.waypoints_m.back();
  decision.fitness.factors = {0.25, 0.5, 0.125};
  return decision;
}

TEST(GoalMessage, NamesEveryFactorInTheOrderOfTheList) {
  goal_t goal = goal_message(decision());
  const std::vector<std::string_view> names = names_of(goal.factor_names);
  ASSERT_EQ(names.size(), kFactors.size());
  EXPECT_EQ(goal.factors, std::ssize(kFactors));
  for (std::size_t i = 0; i < kFactors.size(); ++i) {
    EXPECT_EQ(names[i], kFactors[i].name);
    EXPECT_EQ(goal.factor_value[i], decision().fitness.factors[i]);
    EXPECT_EQ(factor_of(goal, kFactors[i].name), decision().fitness.factors[i]);
  }
  EXPECT_EQ(factor_of(goal, "beauty"), 0.0);
  goal.run = goal.view = goal.attempt = 2;
  EXPECT_EQ(check(goal), "");
}

TEST(GoalMessage, HasTheLengthOfItsPath) {
  EXPECT_DOUBLE_EQ(goal_message(decision()).path_length_m, 7.0);
  EXPECT_EQ(start_goal_message(decision().pose, "paper").path_length_m, 0.0);
  EXPECT_EQ(start_goal_message(decision().pose, "paper").factors, 0) << "it was not decided on";
}

}  // namespace
}  // namespace nextview
