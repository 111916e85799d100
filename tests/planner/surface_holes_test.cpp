#include "planner/surface_holes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <stdexcept>
#include <tuple>

namespace nextview {
namespace {

// A floor of Occupied voxels at k = 2 with Empty ones above it and nothing known below, 20 x 20
// x 10.
class Floor : public ::testing::Test {
 protected:
  Floor() : map({0.1, Eigen::Vector3d::Zero()}, {VoxelIndex::Zero(), VoxelIndex(20, 20, 10)}) {
    for_each_voxel(map.window(), [&](const VoxelIndex& v) {
      map.set_label(v, v[2] < 2 ? Label::Unmarked : v[2] == 2 ? Label::Occupied : Label::Empty);
    });
  }

  VoxelMap map;
};

TEST_F(Floor, ThatIsWholeHasNoHole) { EXPECT_TRUE(surface_holes(map, 10).empty()); }

TEST_F(Floor, AMissingPatchIsAHoleThatOpensUpwards) {
  for (int i = 5; i < 8; ++i) map.set_label({i, 6, 2}, Label::OcclusionPlane);
  const auto holes = surface_holes(map, 10);
  ASSERT_EQ(holes.size(), 1u);
  ASSERT_EQ(holes[0].voxels.size(), 3u);
  for (int n = 0; n < 3; ++n) {
    const HoleVoxel& voxel = holes[0].voxels[static_cast<std::size_t>(n)];
    EXPECT_EQ(voxel.voxel, VoxelIndex(5 + n, 6, 2));
    EXPECT_EQ(voxel.outward, Eigen::Vector3d::UnitZ());
    EXPECT_EQ(voxel.trust, 1.0);
  }
}

TEST_F(Floor, WhatAGapInTheSurfaceOpensIsAHoleBehindIt) {
  map.set_label({5, 6, 2}, Label::Empty);  // seen through, into the unknown
  const auto holes = surface_holes(map, 10);
  ASSERT_EQ(holes.size(), 1u);
  ASSERT_EQ(holes[0].voxels.size(), 1u);
  EXPECT_EQ(holes[0].voxels[0].voxel, VoxelIndex(5, 6, 1));
  EXPECT_EQ(holes[0].voxels[0].outward, Eigen::Vector3d::UnitZ());
}

TEST_F(Floor, PatchesThatTouchAtACornerAreOneHoleAndOthersAreNot) {
  map.set_label({5, 6, 2}, Label::Unmarked);
  map.set_label({6, 7, 2}, Label::Occluded);
  map.set_label({8, 7, 2}, Label::Unmarked);
  const auto holes = surface_holes(map, 10);
  ASSERT_EQ(holes.size(), 2u);
  EXPECT_EQ(holes[0].voxels.size(), 2u);
  ASSERT_EQ(holes[1].voxels.size(), 1u);
  EXPECT_EQ(holes[1].voxels[0].voxel, VoxelIndex(8, 7, 2));
}

TEST_F(Floor, AnUnknownBoxOnItOpensToAllItsSides) {
  for_each_voxel({VoxelIndex(5, 5, 3), VoxelIndex(3, 3, 3)},
                 [&](const VoxelIndex& v) { map.set_label(v, Label::Unmarked); });
  const auto holes = surface_holes(map, 10);
  ASSERT_EQ(holes.size(), 1u);
  // All 27 but the middle one of the lower two layers.
  EXPECT_EQ(holes[0].voxels.size(), 25u);
  for (const HoleVoxel& voxel : holes[0].voxels) {
    if (voxel.voxel == VoxelIndex(6, 6, 5)) {
      EXPECT_EQ(voxel.outward, Eigen::Vector3d::UnitZ());
    }
    if (voxel.voxel == VoxelIndex(5, 5, 3)) {
      EXPECT_NEAR((voxel.outward - Eigen::Vector3d(-1, -1, 0).normalized()).norm(), 0.0, 1e-12);
    }
  }
}

TEST_F(Floor, AVoxelOpenToOppositeSidesHasNoSide) {
  for (const int k : {1, 3}) map.set_label({5, 6, k}, Label::Empty);
  map.set_label({5, 6, 2}, Label::Unmarked);
  map.set_label({5, 6, 0}, Label::Occupied);
  for (const int step : {-1, 1}) {
    map.set_label({5 + step, 6, 1}, Label::Occupied);
    map.set_label({5, 6 + step, 1}, Label::Occupied);
  }
  const auto holes = surface_holes(map, 10);
  ASSERT_EQ(holes.size(), 1u);
  EXPECT_TRUE(holes[0].voxels[0].outward.isZero());
}

TEST_F(Floor, ALargeHoleIsGivenInParts) {
  for (int i = 0; i < 20; ++i) map.set_label({i, 6, 2}, Label::Unmarked);
  const auto holes = surface_holes(map, 7);  // voxels 0 to 7, 8 to 15, 16 to 19
  ASSERT_EQ(holes.size(), 3u);
  EXPECT_EQ(holes[0].voxels.size(), 8u);
  EXPECT_EQ(holes[1].voxels.size(), 8u);
  EXPECT_EQ(holes[2].voxels.size(), 4u);
  EXPECT_THROW(surface_holes(map, 0), std::invalid_argument);
}

bool is_rim(const VoxelMap& map, const VoxelIndex& v) {
  if (map.label(v) == Label::Empty || map.label(v) == Label::Occupied) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const VoxelIndex step = VoxelIndex::Unit(axis);
    if (map.label(v + step) == Label::Empty || map.label(v - step) == Label::Empty) return true;
  }
  return false;
}

// In random worlds every voxel of the rim is in one part, and a part is connected and no larger
// than allowed.
TEST(SurfaceHoles, PartTheRimOfRandomWorlds) {
  std::mt19937 random(1);
  int parts = 0;
  for (int world = 0; world < 200; ++world) {
    // The window of every second one wraps around in the map's buffer.
    const VoxelIndex min = world % 2 == 0 ? VoxelIndex(0, 0, 0) : VoxelIndex(-5, 3, 7);
    VoxelMap map({0.1, Eigen::Vector3d::Zero()}, {min, VoxelIndex(11, 9, 10)});
    for_each_voxel(map.window(), [&](const VoxelIndex& v) {
      map.set_label(v, static_cast<Label>(random() % 16 < 11 ? 3 + random() % 2 : random() % 3));
    });
    const int largest = 1 + world % 5;
    std::set<std::tuple<int, int, int>> found;
    for (const SurfaceHole& hole : surface_holes(map, largest)) {
      ++parts;
      for (std::size_t n = 0; n < hole.voxels.size(); ++n) {
        const VoxelIndex& v = hole.voxels[n].voxel;
        EXPECT_TRUE(is_rim(map, v));
        EXPECT_TRUE(found.insert({v[0], v[1], v[2]}).second);
        EXPECT_LE((v - hole.voxels[0].voxel).cwiseAbs().maxCoeff(), largest);
        EXPECT_TRUE(n == 0 || std::any_of(hole.voxels.begin(),
                                          hole.voxels.begin() + static_cast<std::ptrdiff_t>(n),
                                          [&](const HoleVoxel& other) {
                                            return (other.voxel - v).cwiseAbs().maxCoeff() == 1;
                                          }));
      }
    }
    std::size_t rim = 0;
    for_each_voxel(map.window(), [&](const VoxelIndex& v) { rim += is_rim(map, v) ? 1 : 0; });
    EXPECT_EQ(found.size(), rim);
  }
  EXPECT_GT(parts, 5000);
}

}  // namespace
}  // namespace nextview
