#include "planner/shortest_paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "planner/segment_walk.h"

namespace nextview {
namespace {

using Eigen::Vector3d;

class Paths : public ::testing::Test {
 protected:
  // Clearance of one voxel, body of half a voxel: only the voxels themselves are in the way.
  Paths() {
    parameters.clearance_m = 0.1;
    parameters.body_radius_m = 0.05;
  }

  static VoxelMap empty_map(const VoxelIndex& size) {
    VoxelMap map({0.1, Vector3d::Zero()}, {VoxelIndex::Zero(), size});
    std::ranges::fill(map.labels(), Label::Empty);
    return map;
  }
  static VoxelMap random_map(std::mt19937& random, const VoxelIndex& present) {
    VoxelMap map = empty_map({9, 8, 7});
    for (Label& label : map.labels()) {
      if (random() % 100 < 35) label = random() % 2 == 0 ? Label::Occupied : Label::Occluded;
    }
    map.set_label(present, Label::Empty);
    return map;
  }
  static VoxelIndex voxel_of_random_map(int number) {
    return {number % 9, number / 9 % 8, number / 72};
  }
  static void fill(VoxelMap& map, const VoxelIndex& min, const VoxelIndex& end, Label label) {
    for (int k = min[2]; k < end[2]; ++k) {
      for (int j = min[1]; j < end[1]; ++j) {
        for (int i = min[0]; i < end[0]; ++i) map.set_label({i, j, k}, label);
      }
    }
  }
  void find(const VoxelMap& map, const VoxelIndex& present, double departure_m = 0.0) {
    space.emplace(map, parameters);
    paths.find(*space, map, map.grid().center_m(present), departure_m);
  }

  FeasibilityParameters parameters;
  std::optional<ClearSpace> space;
  ShortestPaths paths;
};

// Lengths by the definition: again and again over all voxels until nothing gets shorter.
std::vector<std::uint32_t> brute_force(const VoxelMap& map, const ClearSpace& space,
                                       const VoxelIndex& present) {
  constexpr std::uint32_t kNone = 1u << 30;
  const VoxelIndex size = map.window().size;
  const auto number = [&](const VoxelIndex& v) {
    return static_cast<std::size_t>(v[0] + size[0] * (v[1] + size[1] * v[2]));
  };
  std::vector<std::uint32_t> lengths(static_cast<std::size_t>(size.prod()), kNone);
  lengths[number(present)] = 0;
  for (bool any = true; any;) {
    any = false;
    for (int v = 0; v < size.prod(); ++v) {
      const VoxelIndex at(v % size[0], v / size[0] % size[1], v / size[0] / size[1]);
      if (lengths[number(at)] == kNone) continue;
      for (int d = 0; d < 27; ++d) {
        const VoxelIndex step(d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1);
        const VoxelIndex next = at + step;
        if (!space.is_clear(next)) continue;
        constexpr std::array<std::uint32_t, 4> kLength = {0, 1000, 1414, 1732};
        const std::uint32_t length =
            lengths[number(at)] + kLength[static_cast<std::size_t>(step.squaredNorm())];
        if (length >= lengths[number(next)]) continue;
        lengths[number(next)] = length;
        any = true;
      }
    }
  }
  return lengths;
}

TEST_F(Paths, AreAsShortAsBruteForceFinds) {
  std::mt19937 random(1);
  int compared = 0;
  int unreachable = 0;
  for (int round = 0; round < 40; ++round) {
    const VoxelIndex present(4, 4, 3);
    const VoxelMap map = random_map(random, present);
    find(map, present);
    const std::vector<std::uint32_t> expected = brute_force(map, *space, present);
    for (int v = 0; v < 9 * 8 * 7; ++v) {
      const VoxelIndex voxel = voxel_of_random_map(v);
      const std::uint32_t length = expected[static_cast<std::size_t>(v)];
      if (length == 1u << 30) {
        EXPECT_EQ(paths.length_m(voxel), ShortestPaths::kUnreachable);
        ++unreachable;
      } else {
        EXPECT_NEAR(paths.length_m(voxel), length * 1e-4, 1e-9);
      }
      ++compared;
    }
  }
  EXPECT_GT(compared, 20000);
  EXPECT_GT(unreachable, 1000);
}

// The search goes on from where it was left, whatever was asked for before, and in the same paths.
TEST_F(Paths, AreTheSameWhenFoundOnlyAsFarAsAsked) {
  std::mt19937 random(2);
  int left_unfound = 0;
  ShortestPaths asked;
  for (int round = 0; round < 40; ++round) {
    const VoxelIndex present(4, 4, 3);
    const VoxelMap map = random_map(random, present);
    find(map, present);
    asked.stand_at(*space, map, map.grid().center_m(present), 0.0);
    for (int question = 0; question < 4; ++question) {
      const VoxelIndex voxel = voxel_of_random_map(static_cast<int>(random() % (9 * 8 * 7)));
      asked.find_as_far_as(voxel);
      ASSERT_EQ(asked.length_m(voxel), paths.length_m(voxel));
      if (asked.length_m(voxel) == ShortestPaths::kUnreachable) continue;
      EXPECT_EQ(asked.waypoints_m(voxel), paths.waypoints_m(voxel));
      left_unfound += static_cast<int>(paths.reached().size() - asked.reached().size());
    }
    asked.find_as_far_as({-5, 0, 0});  // in no window
    if (round % 2 == 0) continue;      // left as it is for the next stand
    asked.find_all();
    EXPECT_EQ(asked.reached(), paths.reached());
  }
  EXPECT_GT(left_unfound, 1000);
}

TEST_F(Paths, GoStraightWhereNothingIsInTheWay) {
  const VoxelMap map = empty_map({20, 20, 5});
  find(map, {2, 2, 2});
  EXPECT_NEAR(paths.length_m({12, 2, 2}), 1.0, 1e-9);
  EXPECT_NEAR(paths.length_m({12, 12, 2}), 1.414, 1e-9);
  const std::vector<Vector3d> way = paths.waypoints_m({12, 7, 2});
  ASSERT_EQ(way.size(), 2u);  // two directions of steps, one straight piece
  EXPECT_TRUE(way.front().isApprox(Vector3d(0.2, 0.2, 0.2)));
  EXPECT_TRUE(way.back().isApprox(Vector3d(1.2, 0.7, 0.2)));
}

TEST_F(Paths, LeadThroughADoorAndRoundItsPosts) {
  VoxelMap map = empty_map({41, 21, 5});
  fill(map, {20, 0, 0}, {21, 21, 5}, Label::Occupied);  // a wall at x = 2.0
  fill(map, {20, 15, 0}, {21, 20, 5}, Label::Empty);    // with a door from y = 1.5 to 2.0
  find(map, {5, 3, 2});
  const double length_m = paths.length_m({35, 3, 2});
  // By way of the door's near edge, as a string would lie, or 8 % longer on the grid.
  const double string_m = 2.0 * std::hypot(1.5, 1.2);
  EXPECT_GE(length_m, string_m - 1e-9);
  EXPECT_LE(length_m, 1.09 * string_m);
  const std::vector<Vector3d> way = paths.waypoints_m({35, 3, 2});
  ASSERT_GE(way.size(), 3u);
  EXPECT_LE(way.size(), 6u);
  double walked_m = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    walked_m += (way[i] - way[i - 1]).norm();
    for (const VoxelIndex& voxel : voxels_along(map.grid(), way[i - 1], way[i])) {
      EXPECT_TRUE(space->is_clear(voxel)) << voxel.transpose();
    }
  }
  EXPECT_LE(walked_m, length_m + 1e-9);
  fill(map, {20, 15, 0}, {21, 20, 5}, Label::Unmarked);  // the door is not known to be one
  find(map, {5, 3, 2});
  EXPECT_EQ(paths.length_m({35, 3, 2}), ShortestPaths::kUnreachable);
}

TEST_F(Paths, KeepTheClearanceAndTheBody) {
  parameters.clearance_m = 0.4;
  parameters.body_radius_m = 0.2;
  VoxelMap map = empty_map({30, 30, 30});
  map.set_label({20, 15, 15}, Label::Occupied);
  map.set_label({5, 15, 15}, Label::Occluded);
  find(map, {15, 8, 15});
  EXPECT_EQ(paths.length_m({17, 15, 15}), ShortestPaths::kUnreachable);  // 3 voxels away
  EXPECT_LT(paths.length_m({16, 15, 15}), 2.0);                          // 4
  EXPECT_EQ(paths.length_m({6, 16, 15}), ShortestPaths::kUnreachable);   // sqrt 2
  EXPECT_EQ(paths.length_m({7, 15, 15}), ShortestPaths::kUnreachable);   // 2, its box 1.5
  EXPECT_LT(paths.length_m({8, 15, 15}), 2.0);                           // 3, its box 2.5
  EXPECT_EQ(paths.length_m({1, 15, 15}), ShortestPaths::kUnreachable);   // the window's rim
  EXPECT_LT(paths.length_m({2, 15, 15}), 2.0);
}

TEST_F(Paths, DepartFromUnknownSurroundings) {
  parameters.body_radius_m = 0.2;
  VoxelMap map = empty_map({40, 20, 20});
  std::ranges::fill(map.labels(), Label::Unmarked);
  fill(map, {5, 10, 10}, {15, 11, 11}, Label::Empty);  // one voxel wide up to x = 1.4 m
  fill(map, {10, 4, 4}, {35, 17, 17}, Label::Empty);   // then as wide as anybody needs
  find(map, {5, 10, 10}, 0.0);
  EXPECT_EQ(paths.length_m({20, 10, 10}), ShortestPaths::kUnreachable);
  find(map, {5, 10, 10}, 0.4);
  EXPECT_EQ(paths.length_m({20, 10, 10}), ShortestPaths::kUnreachable);
  find(map, {5, 10, 10}, 0.8);
  EXPECT_NEAR(paths.length_m({20, 10, 10}), 1.5, 1e-9);
}

TEST_F(Paths, DepartFromWithinTheClearanceButComeNoNearer) {
  parameters.clearance_m = 0.4;
  parameters.body_radius_m = 0.0;
  VoxelMap map = empty_map({40, 40, 20});
  fill(map, {20, 0, 0}, {21, 40, 20}, Label::Occupied);
  find(map, {18, 20, 10}, 0.8);  // two voxels from the wall
  EXPECT_NEAR(paths.length_m({10, 20, 10}), 0.8, 1e-9);
  EXPECT_EQ(paths.length_m({19, 20, 10}), ShortestPaths::kUnreachable);
  EXPECT_EQ(paths.length_m({22, 20, 10}), ShortestPaths::kUnreachable);
  find(map, {10, 20, 10}, 0.8);  // once clear it must stay so
  EXPECT_EQ(paths.length_m({18, 20, 10}), ShortestPaths::kUnreachable);
}

TEST_F(Paths, KeepToWorkspaceAndLift) {
  parameters.workspace_max_m = Vector3d(2.0, 10.0, 10.0);
  parameters.lift_min_m = 0.5;
  parameters.lift_max_m = 1.0;
  find(empty_map({40, 20, 20}), {5, 10, 7});
  EXPECT_LT(paths.length_m({20, 10, 7}), 2.0);
  EXPECT_EQ(paths.length_m({21, 10, 7}), ShortestPaths::kUnreachable);
  EXPECT_LT(paths.length_m({5, 10, 5}), 2.0);
  EXPECT_EQ(paths.length_m({5, 10, 4}), ShortestPaths::kUnreachable);
  EXPECT_EQ(paths.length_m({5, 10, 11}), ShortestPaths::kUnreachable);
}

// Two storeys with a stairwell between them: the lift decides how far up the robot gets.
TEST_F(Paths, LeadToAnotherStoreyWhereTheLiftAllows) {
  VoxelMap map = empty_map({20, 20, 60});
  fill(map, {0, 0, 28}, {20, 20, 31}, Label::Occupied);
  fill(map, {12, 12, 28}, {18, 18, 31}, Label::Empty);
  parameters.lift_max_m = 2.85;
  find(map, {5, 5, 12});
  EXPECT_EQ(paths.length_m({5, 5, 40}), ShortestPaths::kUnreachable);
  EXPECT_LT(paths.length_m({15, 15, 27}), 3.0);
  parameters.lift_max_m = 5.0;
  find(map, {5, 5, 12});
  EXPECT_GT(paths.length_m({5, 5, 40}), 3.0);
  EXPECT_LT(paths.length_m({5, 5, 40}), 5.0);
}

TEST_F(Paths, KeepOutOfWhatIsBlocked) {
  const VoxelMap map = empty_map({20, 20, 5});
  ClearSpace space(map, parameters);
  space.block({1.0, 1.0, 0.2}, 0.1);
  EXPECT_FALSE(space.is_clear(VoxelIndex(10, 10, 2)));
  EXPECT_TRUE(space.is_clear(VoxelIndex(11, 10, 2)));
  space.unblock_all();
  EXPECT_TRUE(space.is_clear(VoxelIndex(10, 10, 2)));
}

TEST(ClearSpace, FollowsTheMapAsIfMadeAnew) {
  std::mt19937 random(2);
  const VoxelIndex size(14, 12, 10);
  FeasibilityParameters parameters;
  parameters.clearance_m = 0.3;
  parameters.body_radius_m = 0.2;
  VoxelMap map({0.1, Vector3d::Zero()}, {VoxelIndex(-3, 2, 0), size});
  ClearSpace followed(map, parameters);
  int clear = 0;
  for (int round = 0; round < 30; ++round) {
    std::vector<std::uint32_t> changed;
    for (int change = 0; change < 400; ++change) {
      const VoxelIndex voxel = map.window().min + VoxelIndex(static_cast<int>(random() % 14),
                                                             static_cast<int>(random() % 12),
                                                             static_cast<int>(random() % 10));
      const auto draw = static_cast<int>(random() % 200);
      const Label label = draw < 196   ? Label::Empty
                          : draw < 199 ? Label::Occupied
                                       : Label::OcclusionPlane;
      map.set_label(voxel, label);
      changed.push_back(static_cast<std::uint32_t>(map.slot(voxel)));
    }
    followed.update(map, changed);
    const ClearSpace anew(map, parameters);
    for (ClearSpace::Cell cell = 0; cell < anew.cells(); ++cell) {
      ASSERT_EQ(followed.is_clear(cell), anew.is_clear(cell));
      clear += anew.is_clear(cell) ? 1 : 0;
    }
  }
  EXPECT_GT(clear, 500);
}

}  // namespace
}  // namespace nextview
