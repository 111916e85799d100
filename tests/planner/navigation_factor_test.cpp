#include "planner/navigation_factor.h"

#include <gtest/gtest.h>

#include <vector>

namespace nextview {
namespace {

using Path = std::vector<Eigen::Vector3d>;

TEST(Travel, OfAPathIsTheLengthOfItsPiecesAndHowMuchItTurns) {
  const Travel straight = travel_along(Path{{0, 0, 1}, {3, 0, 1}, {3, 0, 1}, {5, 0, 1}});
  EXPECT_DOUBLE_EQ(straight.length_m, 5.0);
  EXPECT_EQ(straight.turning, 0.0);
  const Travel right_angle = travel_along(Path{{0, 0, 1}, {3, 0, 1}, {3, 4, 1}});
  EXPECT_DOUBLE_EQ(right_angle.length_m, 7.0);
  EXPECT_DOUBLE_EQ(right_angle.turning, 1.0);
  const Travel up_and_back = travel_along(Path{{0, 0, 1}, {0, 0, 2}, {0, 0, 2}, {0, 0, 1.5}});
  EXPECT_DOUBLE_EQ(up_and_back.length_m, 1.5);
  EXPECT_DOUBLE_EQ(up_and_back.turning, 2.0);
  const Travel zigzag = travel_along(Path{{0, 0, 1}, {1, 0, 1}, {2, 1, 1}, {2, 2, 1}});
  EXPECT_DOUBLE_EQ(zigzag.turning, 2.0 * (1.0 - std::sqrt(0.5)));
}

TEST(Travel, OfNoPathIsNone) {
  EXPECT_EQ(travel_along({}).length_m, 0.0);
  const Travel at_once = travel_along(Path{{1, 2, 3}, {1, 2, 3}});
  EXPECT_EQ(at_once.length_m, 0.0);
  EXPECT_EQ(at_once.turning, 0.0);
}

TEST(NavigationFactor, FromWhereTheRobotStandsIsOne) { EXPECT_EQ(navigation_factor({}), 1.0); }

TEST(NavigationFactor, IsHalvedByTheFirstTwoMetresAndThenMoreSlowly) {
  EXPECT_EQ(navigation_factor({.length_m = 2.0}), 1.0 / 2.0);
  EXPECT_EQ(navigation_factor({.length_m = 4.0}), 1.0 / 3.0);
  EXPECT_EQ(navigation_factor({.length_m = 6.0}), 1.0 / 4.0);
}

TEST(NavigationFactor, ARightAngleCostsAsMuchAsAMetre) {
  EXPECT_EQ(navigation_factor({.length_m = 3.0, .turning = 1.0}),
            navigation_factor({.length_m = 4.0}));
}

TEST(NavigationFactor, TendsToZeroFarAwayAndOnAWindingWay) {
  EXPECT_LT(navigation_factor({.length_m = 2000.0}), 1e-3);
  EXPECT_LT(navigation_factor({.turning = 2000.0}), 1e-3);
  EXPECT_GT(navigation_factor({.length_m = 1e9, .turning = 1e9}), 0.0);
}

}  // namespace
}  // namespace nextview
