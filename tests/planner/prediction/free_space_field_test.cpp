#include "planner/prediction/free_space_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <vector>

namespace nextview {
namespace {

VoxelMap empty_map(const VoxelIndex& min, const VoxelIndex& size) {
  VoxelMap map({0.1, Eigen::Vector3d::Zero()}, {min, size});
  std::fill(map.labels().begin(), map.labels().end(), Label::Empty);
  return map;
}

// The definition, voxel by voxel.
std::uint8_t expected_byte(const VoxelMap& map, const VoxelIndex& index) {
  if (!map.contains(index)) return FreeSpaceField::kOutside;
  const auto is_empty = [&map](const VoxelIndex& at) {
    return map.contains(at) && map.label(at) == Label::Empty;
  };
  switch (map.label(index)) {
    case Label::Occupied:
      return FreeSpaceField::kOccupied;
    case Label::OcclusionPlane:
      return FreeSpaceField::kOcclusionPlane;
    case Label::Unmarked:
    case Label::Occluded:
      return FreeSpaceField::kUnseen;
    case Label::Empty:
      break;
  }
  for (int d = 1; d < FreeSpaceField::kMaxJump; ++d) {
    for (int k = -d; k <= d; ++k) {
      for (int j = -d; j <= d; ++j) {
        const int step = std::max(std::abs(j), std::abs(k)) == d ? 1 : 2 * d;
        for (int i = -d; i <= d; i += step) {
          if (!is_empty(index + VoxelIndex(i, j, k))) {
            return static_cast<std::uint8_t>(d);
          }
        }
      }
    }
  }
  return FreeSpaceField::kMaxJump;
}

// With the layer around the window.
MapWindow with_layer(const MapWindow& window) {
  return {window.min - VoxelIndex::Ones(), window.size + VoxelIndex::Constant(2)};
}

int count_different_bytes(const FreeSpaceField& a, const FreeSpaceField& b) {
  int different = 0;
  for_each_voxel(with_layer(a.window()),
                 [&](const VoxelIndex& voxel) { different += a.at(voxel) != b.at(voxel); });
  return different;
}

int count_wrong_bytes(const FreeSpaceField& field, const VoxelMap& map) {
  int wrong = 0;
  for_each_voxel(with_layer(map.window()), [&](const VoxelIndex& voxel) {
    wrong += field.at(voxel) != expected_byte(map, voxel);
  });
  return wrong;
}

TEST(FreeSpaceField, AnEmptyMapCountsDownToItsLimits) {
  const VoxelMap map = empty_map({0, 0, 0}, {9, 9, 9});
  const FreeSpaceField field(map);
  EXPECT_EQ(field.at({4, 4, 4}), 5);
  EXPECT_EQ(field.at({0, 4, 4}), 1);
  EXPECT_EQ(field.at({4, 7, 4}), 2);
  EXPECT_EQ(field.at({-1, 4, 4}), FreeSpaceField::kOutside);
  EXPECT_EQ(field.at({9, 9, 9}), FreeSpaceField::kOutside);
}

TEST(FreeSpaceField, DistancesEndAtTheLargestJump) {
  const VoxelMap map = empty_map({-40, -40, -40}, {81, 81, 81});
  const FreeSpaceField field(map);
  for (int i = -40; i <= 40; ++i) {
    const int to_limit = 41 - std::abs(i);
    EXPECT_EQ(field.at({i, 0, 0}), std::min<int>(to_limit, FreeSpaceField::kMaxJump));
    EXPECT_EQ(field.at({i, 2, i}), field.at({0, i, 0}));
  }
}

TEST(FreeSpaceField, FollowsRandomChangesOfTheMap) {
  std::mt19937 random(7);
  int updates = 0;
  for (const VoxelIndex& size : {VoxelIndex(30, 20, 12), VoxelIndex(130, 9, 11),
                                 VoxelIndex(62, 5, 40), VoxelIndex(1, 1, 1)}) {
    VoxelMap map = empty_map({-7, 3, -2}, size);
    FreeSpaceField field(map);
    FreeSpaceField by_three(map, 3);
    const auto below = [&random](int n) {
      return static_cast<int>(random() % static_cast<unsigned>(n));
    };
    for (int round = 0; round < 12; ++round) {
      std::vector<std::uint32_t> changed;
      for (int i = below(8); i >= 0; --i) {
        const VoxelIndex index =
            map.window().min + VoxelIndex(below(size[0]), below(size[1]), below(size[2]));
        // Mostly free space, so that distances are long.
        const auto label = below(3) > 0 ? Label::Empty : static_cast<Label>(below(5));
        if (map.label(index) == label) continue;
        map.set_label(index, label);
        const auto slot = static_cast<std::uint32_t>(map.slot(index));
        if (std::find(changed.begin(), changed.end(), slot) == changed.end()) {
          changed.push_back(slot);
        }
      }
      field.update(map, changed);
      by_three.update(map, changed);
      ASSERT_EQ(count_wrong_bytes(field, map), 0) << "round " << round;
      ASSERT_EQ(count_wrong_bytes(by_three, map), 0) << "round " << round << ", three threads";
      ++updates;
    }
  }
  EXPECT_EQ(updates, 48);
}

// A field that began without distances has the true ones where they can have changed, and elsewhere
// none that leads past anything.
TEST(FreeSpaceField, OneThatBeginsAllEmptyHasDistancesAroundWhatChanged) {
  std::mt19937 random(11);
  VoxelMap map = empty_map({-7, 3, -2}, {110, 14, 12});
  FreeSpaceField field = FreeSpaceField::all_empty(map.window());
  for_each_voxel(with_layer(map.window()), [&](const VoxelIndex& voxel) {
    ASSERT_EQ(field.at(voxel), map.contains(voxel) ? 1 : FreeSpaceField::kOutside);
  });
  const auto below = [&random](int n) {
    return static_cast<int>(random() % static_cast<unsigned>(n));
  };
  const VoxelIndex corner(10, 5, 0);
  for (int round = 0; round < 3; ++round) {
    std::vector<std::uint32_t> changed;
    for (int i = 0; i < 6; ++i) {
      const VoxelIndex index = corner + VoxelIndex(below(10), below(10), below(10));
      if (map.label(index) != Label::Empty) continue;
      map.set_label(index, static_cast<Label>(below(5)));
      changed.push_back(static_cast<std::uint32_t>(map.slot(index)));
    }
    field.update(map, changed);
    int step_by_step = 0;
    for_each_voxel(with_layer(map.window()), [&](const VoxelIndex& voxel) {
      const std::uint8_t expected = expected_byte(map, voxel);
      if (field.at(voxel) == expected) return;
      ASSERT_EQ(field.at(voxel), 1);
      ASSERT_LE(expected, FreeSpaceField::kMaxJump);
      // More than a jump away from what changed, whole vectors of a row considered.
      ASSERT_GT((voxel - corner).cwiseAbs().maxCoeff(), FreeSpaceField::kMaxJump - 1);
      ++step_by_step;
    });
    EXPECT_GT(step_by_step, 0);
  }
}

// Changes of labels and moves of the window, one after the other; a move is told together with the
// changes it brings about, and sometimes with others from after it.
TEST(FreeSpaceField, FollowsAWindowThatMoves) {
  std::mt19937 random(8);
  const auto below = [&random](int n) {
    return static_cast<int>(random() % static_cast<unsigned>(n));
  };
  int moves = 0;
  for (const VoxelIndex& size : {VoxelIndex(30, 20, 12), VoxelIndex(90, 9, 11),
                                 VoxelIndex(33, 34, 35), VoxelIndex(1, 2, 1)}) {
    VoxelMap map = empty_map({-7, 3, -2}, size);
    FreeSpaceField field(map);
    FreeSpaceField by_three(map, 3);
    for (int round = 0; round < 15; ++round) {
      VoxelIndex step = VoxelIndex::Zero();
      const int reach = round % 5 == 4 ? 2 * size.maxCoeff() : 3;  // also past all it holds
      for (int axis = 0; axis < 3; ++axis) {
        if (below(2) == 0) step[axis] = below(2 * reach + 1) - reach;
      }
      map.move_window(map.window().min + step);
      std::set<std::uint32_t> changed;
      const bool fill = below(2) == 0;
      for_each_voxel(map.window(), [&](const VoxelIndex& voxel) {
        if (map.label(voxel) != Label::Unmarked || !fill) return;
        map.set_label(voxel, below(30) > 0 ? Label::Empty : Label::Occupied);
        changed.insert(static_cast<std::uint32_t>(map.slot(voxel)));
      });
      const std::vector<std::uint32_t> slots(changed.begin(), changed.end());
      field.update(map, slots);
      by_three.update(map, slots);
      ASSERT_EQ(field.window().min, map.window().min);
      ASSERT_EQ(count_wrong_bytes(field, map), 0) << "round " << round;
      ASSERT_EQ(count_wrong_bytes(by_three, map), 0) << "round " << round << ", three threads";
      ASSERT_EQ(count_different_bytes(field, FreeSpaceField(map)), 0) << "round " << round;
      moves += !step.isZero();
    }
  }
  EXPECT_GT(moves, 40);
}

TEST(FreeSpaceField, AnOffsetLeadsBackToItsVoxel) {
  const VoxelMap map = empty_map({-7, 3, -2}, {30, 20, 12});
  const FreeSpaceField field(map);
  for_each_voxel(with_layer(map.window()), [&](const VoxelIndex& voxel) {
    ASSERT_EQ(field.index_of(field.offset(voxel)), voxel);
  });
}

}  // namespace
}  // namespace nextview
