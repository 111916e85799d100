#include "planner/feasibility.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include "planner/clear_space.h"
#include "planner/refused_places.h"
#include "planner/segment_walk.h"
#include "planner/shortest_paths.h"
#include "sensor/random_stream.h"

namespace nextview {
namespace {

using Eigen::Vector3d;

// 40 x 40 x 20 voxels of 0.1 m, all Empty, voxel centres at multiples of 0.1 m.
class EmptyHall : public ::testing::Test {
 protected:
  EmptyHall() : map({0.1, Vector3d::Zero()}, {VoxelIndex::Zero(), VoxelIndex(40, 40, 20)}) {
    fill({0, 0, 0}, {40, 40, 20}, Label::Empty);
  }

  void fill(const VoxelIndex& min, const VoxelIndex& end, Label label) {
    for (int k = min[2]; k < end[2]; ++k) {
      for (int j = min[1]; j < end[1]; ++j) {
        for (int i = min[0]; i < end[0]; ++i) map.set_label({i, j, k}, label);
      }
    }
  }
  void stand() {
    space.emplace(map, parameters);
    paths.stand_at(*space, map, present_m, parameters.departure_m);
  }
  bool straight_from_there(const Vector3d& position_m) const {
    return parameters.within_limits(position_m) && paths.may_be_at(position_m) &&
           paths.leads_straight_to(position_m);
  }
  /// Straight from the present position.
  bool reachable(const Vector3d& position_m) {
    stand();
    return straight_from_there(position_m);
  }

  VoxelMap map;
  FeasibilityParameters parameters;
  Vector3d present_m{1.0, 2.0, 1.0};
  std::optional<ClearSpace> space;
  ShortestPaths paths;
};

TEST_F(EmptyHall, EverythingEmptyIsReachable) {
  EXPECT_TRUE(reachable(present_m));
  EXPECT_TRUE(reachable({3.0, 2.0, 1.0}));
  EXPECT_TRUE(reachable({3.03, 3.07, 0.55}));
}

TEST_F(EmptyHall, AWallKeepsItsClearance) {
  fill({30, 0, 0}, {31, 40, 20}, Label::Occupied);  // x = 3.0 m
  EXPECT_TRUE(reachable({2.6, 2.0, 1.0}));          // 0.40 m: not nearer
  EXPECT_TRUE(reachable({2.64, 2.0, 1.0}));         // of the same voxel
  EXPECT_FALSE(reachable({2.7, 2.0, 1.0}));
  EXPECT_FALSE(reachable({3.0, 2.0, 1.0}));  // in the wall
  EXPECT_FALSE(reachable({3.5, 2.0, 1.0}));  // behind it
}

TEST_F(EmptyHall, ACornerIsMeasuredAlongTheDiagonal) {
  map.set_label({30, 30, 10}, Label::Occupied);
  EXPECT_FALSE(reachable({2.8, 2.7, 1.0}));  // 2, 3 voxels: sqrt 13 < 4
  EXPECT_TRUE(reachable({2.7, 2.7, 1.0}));   // 3, 3 voxels: sqrt 18 > 4
}

TEST_F(EmptyHall, ThePathKeepsTheClearanceToo) {
  map.set_label({20, 23, 10}, Label::Occupied);  // 0.3 m beside the way
  EXPECT_FALSE(reachable({3.0, 2.0, 1.0}));
  EXPECT_TRUE(reachable({3.0, 1.7, 1.0}));
}

TEST_F(EmptyHall, ThePathMustBeKnownEmpty) {
  for (const Label unknown : {Label::Unmarked, Label::Occluded, Label::OcclusionPlane}) {
    parameters.body_radius_m = 0.0;
    map.set_label({25, 20, 10}, unknown);
    EXPECT_FALSE(reachable({3.0, 2.0, 1.0}));
    EXPECT_FALSE(reachable({2.5, 2.0, 1.0}));
    EXPECT_TRUE(reachable({2.4, 2.0, 1.0}));
    EXPECT_TRUE(reachable({3.0, 2.0, 1.2}));
  }
}

TEST_F(EmptyHall, NothingUnknownMayBeWithinTheBody) {
  map.set_label({25, 22, 10}, Label::Unmarked);  // begins 0.15 m beside the way
  EXPECT_FALSE(reachable({3.0, 2.0, 1.0}));
  parameters.body_radius_m = 0.15;
  EXPECT_TRUE(reachable({3.0, 2.0, 1.0}));
}

// What an unknown voxel hides may be in its nearest corner.
TEST(VoxelNearness, IsOfCentresOrOfBoxes) {
  const VoxelNearness near(0.2, 0.1);
  EXPECT_TRUE(near.center_is_nearer({1, 1, 1}));
  EXPECT_FALSE(near.center_is_nearer({2, 0, 0}));
  EXPECT_TRUE(near.box_is_nearer({0, 0, 0}));
  EXPECT_TRUE(near.box_is_nearer({-2, 0, 0}));   // 0.15 m
  EXPECT_TRUE(near.box_is_nearer({2, 1, -1}));   // hypot(0.15, 0.05, 0.05) = 0.166 m
  EXPECT_FALSE(near.box_is_nearer({2, -2, 0}));  // hypot(0.15, 0.15) = 0.212 m
  EXPECT_FALSE(near.box_is_nearer({3, 0, 0}));   // 0.25 m
  EXPECT_TRUE(VoxelNearness(0.26, 0.1).box_is_nearer({0, 3, 0}));
  EXPECT_FALSE(VoxelNearness(0.25, 0.1).box_is_nearer({0, 3, 0}));
  EXPECT_FALSE(VoxelNearness(0.0, 0.1).box_is_nearer({0, 0, 0}));
  // Nothing beyond the reach is nearer, and something at it may be.
  for (double length_m = 0.01; length_m < 0.6; length_m += 0.01) {
    const VoxelNearness nearness(length_m, 0.1);
    EXPECT_FALSE(nearness.box_is_nearer({nearness.reach() + 1, 0, 0})) << length_m;
    EXPECT_FALSE(nearness.center_is_nearer({nearness.reach() + 1, 0, 0})) << length_m;
    EXPECT_TRUE(nearness.box_is_nearer({nearness.reach() - 1, 0, 0})) << length_m;
  }
}

TEST_F(EmptyHall, UnknownSpaceWhereTheRobotStandsDoesNotHoldIt) {
  fill({0, 21, 0}, {17, 40, 20}, Label::Unmarked);  // beside the way for 0.7 m
  EXPECT_TRUE(reachable({3.0, 2.0, 1.0}));
  parameters.departure_m = 0.4;
  EXPECT_FALSE(reachable({3.0, 2.0, 1.0}));
}

TEST_F(EmptyHall, TheWindowEndsTheKnownSpace) {
  EXPECT_TRUE(reachable({3.7, 2.0, 1.0}));  // voxel 37 of 0..39, the body's 2 inside
  EXPECT_FALSE(reachable({3.9, 2.0, 1.0}));
  EXPECT_FALSE(reachable({4.2, 2.0, 1.0}));
}

TEST_F(EmptyHall, WorkspaceAndLiftLimitThePosition) {
  parameters.workspace_min_m = {0.5, 0.5, 0.5};
  parameters.workspace_max_m = {3.0, 3.0, 1.5};
  parameters.lift_min_m = 0.8;
  parameters.lift_max_m = 1.2;
  EXPECT_TRUE(reachable({2.9, 2.9, 1.1}));
  EXPECT_FALSE(reachable({3.01, 2.0, 1.0}));
  EXPECT_FALSE(reachable({0.49, 2.0, 1.0}));
  EXPECT_FALSE(reachable({2.0, 2.0, 1.21}));
  EXPECT_FALSE(reachable({2.0, 2.0, 0.79}));
}

TEST_F(EmptyHall, APositionThatTurnedOutTooNearCanBeLeftButNotMadeWorse) {
  map.set_label({10, 23, 10}, Label::Occupied);  // 0.3 m from where the sensor stands
  EXPECT_TRUE(reachable(present_m));
  EXPECT_TRUE(reachable({1.0, 1.5, 1.0}));
  EXPECT_TRUE(reachable({2.0, 2.0, 1.0}));
  EXPECT_FALSE(reachable({1.0, 2.1, 1.0}));
  map.set_label({20, 23, 10}, Label::Occupied);  // once clear, it must stay clear
  EXPECT_FALSE(reachable({3.0, 2.0, 1.0}));
}

// There is a place behind an obstacle, and a path that is not straight leads there.
TEST_F(EmptyHall, WhatIsNotStraightAheadHasAPathRoundTheObstacle) {
  fill({20, 15, 0}, {21, 26, 20}, Label::Occupied);  // from y = 1.5 to 2.5 m
  const Vector3d behind_m(3.03, 2.02, 1.0);
  EXPECT_FALSE(reachable(behind_m));
  EXPECT_TRUE(paths.may_be_at(behind_m));
  paths.find_all();
  const std::vector<Vector3d> way = paths.waypoints_to_m(behind_m);
  ASSERT_GE(way.size(), 3U);
  EXPECT_EQ(way.front(), present_m);
  EXPECT_EQ(way.back(), behind_m);
  double length_m = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    length_m += (way[i] - way[i - 1]).norm();
    for (double t = 0.0; t <= 1.0; t += 0.01) {
      const Vector3d at_m = way[i - 1] + t * (way[i] - way[i - 1]);
      const double beside_m = std::clamp(at_m.y(), 1.5, 2.5);
      EXPECT_GT(std::hypot(at_m.x() - 2.0, at_m.y() - beside_m), 0.4 - 0.087);
    }
  }
  EXPECT_GT(length_m, 2.0 * std::hypot(1.0, 0.5));
  EXPECT_LT(length_m, 3.0);
  const std::vector<Vector3d> straight = paths.waypoints_to_m(Vector3d(1.52, 2.0, 1.0));
  EXPECT_EQ(straight, (std::vector<Vector3d>{present_m, {1.52, 2.0, 1.0}}));
}

TEST_F(EmptyHall, RefusedGoalsAreKeptOutOfUntilSomethingBecomesKnownThere) {
  stand();
  RefusedPlaces refused;
  const std::vector<Vector3d> way = {present_m, {2.5, 2.0, 1.0}};
  refused.add(*space, way, 1);
  const auto can_be_at = [&](const Vector3d& position_m) {
    return space->is_clear(map.grid().voxel_of(position_m));
  };
  EXPECT_FALSE(can_be_at({2.5, 2.0, 1.0}));
  EXPECT_FALSE(can_be_at({2.6, 2.2, 1.0}));  // nearer than the clearance
  EXPECT_TRUE(can_be_at({2.0, 2.0, 1.0}));
  EXPECT_TRUE(can_be_at({3.5, 2.0, 1.0}));
  const auto becomes_known = [&](const VoxelIndex& voxel) {
    const std::vector<std::uint32_t> slots = {static_cast<std::uint32_t>(map.slot(voxel))};
    map.set_label(voxel, Label::Unmarked);
    space->update(map, slots);
    map.set_label(voxel, Label::Empty);
    refused.forget_near(*space, map, space->update(map, slots));
  };
  becomes_known({35, 20, 10});
  EXPECT_FALSE(can_be_at({2.5, 2.0, 1.0}));
  becomes_known({27, 20, 10});
  EXPECT_TRUE(can_be_at({2.5, 2.0, 1.0}));
  EXPECT_TRUE(refused.empty());
}

// The second refusal of a view says that it may not have been the goal.
TEST_F(EmptyHall, AfterASecondRefusalTheCornersAreKeptOutOfToo) {
  stand();
  RefusedPlaces refused;
  const std::vector<Vector3d> way = {present_m, {2.0, 3.0, 1.0}, {3.2, 3.0, 1.0}};
  refused.add(*space, way, 1);
  EXPECT_TRUE(space->is_clear(VoxelIndex(20, 30, 10)));
  refused.add(*space, way, 2);
  EXPECT_FALSE(space->is_clear(VoxelIndex(20, 30, 10)));
  EXPECT_TRUE(space->is_clear(VoxelIndex(10, 20, 10)));  // where the robot stands
}

// A ball about a goal that is near must not shut the robot in.
TEST_F(EmptyHall, ARefusedGoalNearbyLeavesRoomToGoElsewhere) {
  stand();
  RefusedPlaces refused;
  refused.add(*space, std::vector<Vector3d>{present_m, {1.3, 2.0, 1.0}}, 1);
  paths.stand_at(*space, map, present_m, parameters.departure_m);
  EXPECT_FALSE(straight_from_there({1.3, 2.0, 1.0}));
  EXPECT_TRUE(straight_from_there({1.0, 3.0, 1.0}));
}

// The rules of FeasibilityParameters, looking all around every voxel of a straight path.
bool plainly_reachable(const VoxelMap& map, const FeasibilityParameters& parameters,
                       const Vector3d& from_m, const Vector3d& to_m) {
  const VoxelIndex present = map.grid().voxel_of(from_m);
  const int reach = 5;
  const auto nearest_occupied = [&](const VoxelIndex& voxel) {
    int nearest = 16;  // 0.40 m, squared voxels
    for (int k = -reach; k <= reach; ++k) {
      for (int j = -reach; j <= reach; ++j) {
        for (int i = -reach; i <= reach; ++i) {
          const VoxelIndex step(i, j, k);
          if (map.label(voxel + step) == Label::Occupied) {
            nearest = std::min(nearest, step.squaredNorm());
          }
        }
      }
    }
    return nearest;
  };
  const auto unknown_near = [&](const VoxelIndex& voxel) {
    for (int k = -2; k <= 2; ++k) {
      for (int j = -2; j <= 2; ++j) {
        for (int i = -2; i <= 2; ++i) {
          // From the voxel's centre to the nearest point of the box, in voxels.
          const Vector3d apart =
              (Vector3d(i, j, k).cwiseAbs() - Vector3d::Constant(0.5)).cwiseMax(0);
          if (apart.norm() >= 2.0) continue;  // not nearer than 0.20 m
          const VoxelIndex at = voxel + VoxelIndex(i, j, k);
          const Label label = map.label(at);
          const bool unknown = label != Label::Empty && label != Label::Occupied;
          if (unknown && (at - present).squaredNorm() >= 100) return true;  // from 1.00 m on
        }
      }
    }
    return false;
  };
  if (!(to_m.array() >= parameters.workspace_min_m.array()).all()) return false;
  int allowed = nearest_occupied(present);
  for (const VoxelIndex& voxel : voxels_along(map.grid(), from_m, to_m)) {
    if (voxel == present) continue;
    const int nearest = nearest_occupied(voxel);
    if (map.label(voxel) != Label::Empty || unknown_near(voxel) || nearest < allowed) return false;
    if (nearest == 16) allowed = 16;
  }
  return true;
}

TEST_F(EmptyHall, AgreesWithLookingAllAroundEveryVoxel) {
  RandomStream random(4, 1, 1, RandomPurpose::InitialSimplex);
  const auto below = [&random](int n) {
    return static_cast<int>(random.below(static_cast<std::uint32_t>(n)));
  };
  int reached = 0;
  int cases = 0;
  for (int round = 0; round < 60; ++round) {
    fill({0, 0, 0}, {40, 40, 20}, Label::Empty);
    for (int block = 0; block < 12; ++block) {
      const VoxelIndex corner(below(38), below(38), below(18));
      fill(corner, corner + VoxelIndex(1 + below(2), 1 + below(2), 1 + below(2)),
           static_cast<Label>(block % 2 == 0 ? below(3) : 4));
    }
    stand();
    for (int i = 0; i < 80; ++i) {
      const Vector3d to_m(4.0 * random.uniform(), 4.0 * random.uniform(), 2.0 * random.uniform());
      const bool expected = plainly_reachable(map, parameters, present_m, to_m);
      ASSERT_EQ(straight_from_there(to_m), expected)
          << "round " << round << ", " << to_m.transpose();
      reached += expected;
      ++cases;
    }
  }
  EXPECT_EQ(cases, 4800);
  EXPECT_GT(reached, 500);
  EXPECT_LT(reached, 4300);
}

TEST_F(EmptyHall, ParametersThatCannotBeAreNamed) {
  parameters.clearance_m = -0.1;
  EXPECT_THROW(reachable(present_m), std::invalid_argument);
  parameters = {};
  parameters.workspace_max_m = parameters.workspace_min_m;
  EXPECT_THROW(reachable(present_m), std::invalid_argument);
  parameters = {};
  present_m = {9.0, 2.0, 1.0};
  EXPECT_THROW(reachable({1.0, 1.0, 1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace nextview
