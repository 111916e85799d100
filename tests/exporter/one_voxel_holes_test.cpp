#include "exporter/one_voxel_holes.h"

#include <gtest/gtest.h>

#include <cstring>
#include <sstream>

#include "exporter/point_clouds.h"
#include "mapper/map_digest.h"

namespace nextview {
namespace {

// A wall of Occupied voxels at j = 5, free before it, nothing known behind.
VoxelMap wall() {
  VoxelMap map({0.1, Eigen::Vector3d::Zero()}, {VoxelIndex::Zero(), VoxelIndex(12, 9, 10)});
  for_each_voxel(map.window(), [&](const VoxelIndex& v) {
    map.set_label(v, v[1] < 5 ? Label::Empty : v[1] == 5 ? Label::Occupied : Label::Unmarked);
  });
  return map;
}

std::vector<VoxelIndex> holes_with(const std::vector<VoxelIndex>& missing, Label label) {
  VoxelMap map = wall();
  for (const VoxelIndex& voxel : missing) map.set_label(voxel, label);
  return one_voxel_holes(map);
}

using Holes = std::vector<VoxelIndex>;

TEST(OneVoxelHoles, OfAWholeWallAreNone) { EXPECT_TRUE(one_voxel_holes(wall()).empty()); }

TEST(OneVoxelHoles, AVoxelMissingInAWallIsOneWhateverIsKnownOfIt) {
  const Holes missing = {{4, 5, 4}};
  for (const Label label :
       {Label::Unmarked, Label::Occluded, Label::OcclusionPlane, Label::Empty}) {
    EXPECT_EQ(holes_with(missing, label), missing);
  }
}

TEST(OneVoxelHoles, TwoThatTouchAtAnEdgeAreTwoHoles) {
  const Holes missing = {{4, 5, 4}, {5, 5, 5}};
  EXPECT_EQ(holes_with(missing, Label::Unmarked), missing);
}

TEST(OneVoxelHoles, AGapOfTwoASlitAndADoorAreNone) {
  EXPECT_TRUE(holes_with({{4, 5, 4}, {5, 5, 4}}, Label::Unmarked).empty());
  Holes slit;
  Holes door;
  for (int k = 2; k < 8; ++k) slit.push_back({4, 5, k});
  for (int k = 0; k < 8; ++k) {
    for (int i = 3; i < 9; ++i) door.push_back({i, 5, k});
  }
  for (const Label label : {Label::Unmarked, Label::Empty}) {
    EXPECT_TRUE(holes_with(slit, label).empty());
    EXPECT_TRUE(holes_with(door, label).empty());
  }
}

TEST(OneVoxelHoles, APipeThroughAThickWallIsNone) {
  VoxelMap map = wall();
  for_each_voxel({VoxelIndex(0, 6, 0), VoxelIndex(12, 1, 10)},
                 [&](const VoxelIndex& v) { map.set_label(v, Label::Occupied); });
  map.set_label({4, 5, 4}, Label::Empty);
  EXPECT_EQ(one_voxel_holes(map), (Holes{{4, 5, 4}})) << "a dent";
  map.set_label({4, 6, 4}, Label::Empty);
  EXPECT_TRUE(one_voxel_holes(map).empty());
}

TEST(OneVoxelHoles, WhatNobodyCanLookAtIsNone) {
  VoxelMap map = wall();
  for_each_voxel({VoxelIndex(0, 6, 0), VoxelIndex(12, 2, 10)},
                 [&](const VoxelIndex& v) { map.set_label(v, Label::Occupied); });
  map.set_label({4, 6, 4}, Label::Unmarked);  // inside the wall
  EXPECT_TRUE(one_voxel_holes(map).empty());
}

TEST(OneVoxelHoles, AVoxelMissingAtTheRimOfAWallIsNone) {
  EXPECT_TRUE(holes_with({{0, 5, 4}}, Label::Unmarked).empty());
}

TEST(OneVoxelHoles, LeaveTheMapAndItsDigestAsTheyAre) {
  VoxelMap map = wall();
  map.set_label({4, 5, 4}, Label::Empty);
  const std::string before = map_digest(map);
  std::ostringstream file;
  write_filled_voxels(file, PointFormat::Ply, map, one_voxel_holes(map));
  EXPECT_EQ(map_digest(map), before);
  EXPECT_EQ(map.label({4, 5, 4}), Label::Empty);
  EXPECT_EQ(map.surface({4, 5, 4}), nullptr);
}

// The 120 voxels of the wall less one, and that one behind them, told apart.
TEST(OneVoxelHoles, AreToldFromWhatWasSensedInAFile) {
  VoxelMap map = wall();
  map.set_label({4, 5, 4}, Label::Empty);
  std::ostringstream file;
  write_filled_voxels(file, PointFormat::Ply, map, one_voxel_holes(map));
  const std::string text = file.str();
  EXPECT_NE(text.find("element vertex 120\n"), std::string::npos);
  EXPECT_NE(text.find("property uint filled\n"), std::string::npos);
  constexpr std::size_t kRow = 8 * 4;  // seven floats and the mark
  const std::string points = text.substr(text.size() - 120 * kRow);
  for (std::size_t n = 0; n < 120; ++n) {
    EXPECT_EQ(points[n * kRow + 28], n == 119 ? 1 : 0);
  }
  float x = 0.0F;
  std::memcpy(&x, &points[119 * kRow], sizeof x);
  EXPECT_FLOAT_EQ(x, 0.4F);
}

}  // namespace
}  // namespace nextview
