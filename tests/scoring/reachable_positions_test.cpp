#include "scoring/reachable_positions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "tests/scoring/room_mesh.h"

namespace nextview {
namespace {

ReachParameters whole_room(const Eigen::Vector3d& size) {
  ReachParameters reach;
  reach.box_max_m = size;
  return reach;
}

TEST(ReachablePositions, FillAnEmptyRoomUpToTheClearance) {
  const Eigen::Vector3d size(3.0, 2.0, 2.0);
  const Scene scene(room(size));
  const auto positions = reachable_positions(scene, {1.5, 1.0, 1.0}, whole_room(size));
  // From 1.5 by 0.25 within [0.4, 2.6]: 0.5 .. 2.5, nine of them; from 1.0 within [0.4, 1.6]:
  // 0.5 .. 1.5, five of them.
  EXPECT_EQ(positions.size(), 9u * 5u * 5u);
  EXPECT_EQ(positions[0], Eigen::Vector3d(1.5, 1.0, 1.0));
}

TEST(ReachablePositions, KeepToTheBox) {
  const Eigen::Vector3d size(3.0, 2.0, 2.0);
  const Scene scene(room(size));
  ReachParameters reach = whole_room(size);
  reach.box_min_m.z() = 0.8;  // lift limits: 1.0 and 1.25 are left of five heights
  reach.box_max_m.z() = 1.3;
  EXPECT_EQ(reachable_positions(scene, {1.5, 1.0, 1.0}, reach).size(), 9u * 5u * 2u);
}

TEST(ReachablePositions, DoNotPassThroughAThinWall) {
  const Eigen::Vector3d size(6.0, 2.0, 2.0);
  TriangleMesh mesh = room(size);
  // A wall at x = 3.1 from wall to wall, so thin that no grid position is in it.
  add_box(mesh, {3.10, 0.0, 0.0}, {3.11, 2.0, 2.0});
  const Scene scene(mesh);
  const auto positions = reachable_positions(scene, {1.5, 1.0, 1.0}, whole_room(size));
  // 0.5 .. 2.5 is 0.6 m from the wall, the next one, 2.75, only 0.35 m.
  EXPECT_EQ(positions.size(), 9u * 5u * 5u);
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

TEST(ReachablePositions, AreTheStartAloneWhereNothingElseIsFree) {
  const Eigen::Vector3d size(1.0, 1.0, 1.0);
  const Scene scene(room(size));
  EXPECT_EQ(reachable_positions(scene, {0.5, 0.5, 0.5}, whole_room(size)).size(), 1u);
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
