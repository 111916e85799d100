#include "scoring/reachable_positions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "scoring/coverage_unknown.h"
#include "tests/scoring/room_mesh.h"

namespace nextview {
namespace {

ReachParameters whole_room(const Eigen::Vector3d& size) {
  ReachParameters reach;
  reach.box_max_m = size;
  return reach;
}

TEST(ReachablePositions, FillAnEmptyRoomUpToTheClearance) {
  const Eigen::Vector3d size(3.01, 2.01, 2.01);
  const Scene scene(room(size));
  const auto positions = reachable_positions(scene, {1.5, 1.0, 1.0}, whole_room(size));
  // Multiples of 0.1 within [0.4, 2.61]: 0.5 .. 2.6 and, rounding permitting, 0.4, which lies
  // exactly at the clearance; likewise within [0.4, 1.61].
  EXPECT_GE(positions.size(), 22u * 12u * 12u);
  EXPECT_LE(positions.size(), 23u * 13u * 13u);
}

TEST(ReachablePositions, LieOnALatticeThatKnowsNoStart) {
  const Eigen::Vector3d size(3.03, 2.03, 2.03);
  const Scene scene(room(size));
  ReachParameters reach = whole_room(size);
  reach.clearance_m = 0.45;
  // 0.5 .. 2.5 within [0.45, 2.58], and 0.5 .. 1.5 within [0.45, 1.58].
  const auto first = reachable_positions(scene, {1.5, 1.0, 1.0}, reach);
  EXPECT_EQ(first.size(), 21u * 11u * 11u);
  EXPECT_TRUE(first[0].isApprox(Eigen::Vector3d(0.5, 0.5, 0.5)));
  for (const Eigen::Vector3d& start_m :
       {Eigen::Vector3d(1.55, 1.04, 0.93), Eigen::Vector3d(0.46, 0.46, 0.46),
        Eigen::Vector3d(2.57, 1.57, 1.57)}) {
    EXPECT_EQ(reachable_positions(scene, start_m, reach), first) << start_m.transpose();
  }
}

TEST(ReachablePositions, KeepToTheBox) {
  const Eigen::Vector3d size(3.03, 2.03, 2.03);
  const Scene scene(room(size));
  ReachParameters reach = whole_room(size);
  reach.clearance_m = 0.45;
  reach.box_min_m.z() = 0.85;  // lift limits: 0.9, 1.0, 1.1 and 1.2
  reach.box_max_m.z() = 1.25;
  EXPECT_EQ(reachable_positions(scene, {1.5, 1.0, 1.0}, reach).size(), 21u * 11u * 4u);
}

TEST(ReachablePositions, DoNotPassThroughAThinWall) {
  const Eigen::Vector3d size(6.03, 2.03, 2.03);
  TriangleMesh mesh = room(size);
  add_box(mesh, {3.03, 0.0, 0.0}, {3.04, 2.03, 2.03});
  const Scene scene(mesh);
  ReachParameters reach = whole_room(size);
  reach.clearance_m = 0.02;  // so that 3.0 and 3.1, beside the wall, are free
  const auto positions = reachable_positions(scene, {1.5, 1.0, 1.0}, reach);
  EXPECT_TRUE(std::all_of(positions.begin(), positions.end(),
                          [](const auto& position) { return position.x() < 3.03; }));
  EXPECT_TRUE(std::any_of(positions.begin(), positions.end(),
                          [](const auto& position) { return position.x() > 2.95; }));
}

TEST(ReachablePositions, GoRoundAWallThatLeavesAWay) {
  const Eigen::Vector3d size(6.0, 4.0, 2.0);
  TriangleMesh mesh = room(size);
  add_box(mesh, {3.10, 0.0, 0.0}, {3.11, 2.0, 2.0});
  const Scene scene(mesh);
  const auto positions = reachable_positions(scene, {1.5, 1.0, 1.0}, whole_room(size));
  EXPECT_TRUE(std::any_of(positions.begin(), positions.end(),
                          [](const auto& p) { return p.x() > 4.0 && p.y() < 1.0; }));
}

TEST(ReachablePositions, AreNoneWhereTheStartJoinsNothing) {
  const Eigen::Vector3d size(1.0, 1.0, 0.7);
  const Scene scene(room(size));
  EXPECT_TRUE(reachable_positions(scene, {0.5, 0.5, 0.35}, whole_room(size)).empty());
}

TEST(ReachablePositions, RefuseToBeMoreThanTheyMay) {
  const Eigen::Vector3d size(3.0, 2.0, 2.0);
  const Scene scene(room(size));
  ReachParameters reach = whole_room(size);
  reach.most_positions = 1000;
  EXPECT_THROW(reachable_positions(scene, {1.5, 1.0, 1.0}, reach), CoverageUnknown);
}

TEST(ReachablePositions, RefuseNumbersThatCannotBe) {
  const Scene scene(room({1.0, 1.0, 1.0}));
  ReachParameters reach = whole_room({1.0, 1.0, 1.0});
  reach.spacing_m = 0.0;
  EXPECT_THROW(reachable_positions(scene, {0.5, 0.5, 0.5}, reach), std::invalid_argument);
  reach = whole_room({1.0, 1.0, std::numeric_limits<double>::infinity()});
  EXPECT_THROW(reachable_positions(scene, {0.5, 0.5, 0.5}, reach), std::invalid_argument);
}

}  // namespace
}  // namespace nextview
