#include "mapper/voxel_grid.h"

#include <gtest/gtest.h>

namespace nextview {
namespace {

TEST(VoxelGrid, NearestCentreTiesAwayFromZero) {
  VoxelGrid grid;
  grid.voxel_size_m = 0.5;  // exact in binary, so the ties are ties
  EXPECT_EQ(grid.voxel_of({0.0, 0.2, -0.2}), VoxelIndex(0, 0, 0));
  EXPECT_EQ(grid.voxel_of({0.25, -0.25, 0.75}), VoxelIndex(1, -1, 2));
  EXPECT_EQ(grid.voxel_of({-0.75, 0.74, -0.74}), VoxelIndex(-2, 1, -1));
  EXPECT_EQ(grid.voxel_of({0.24999, -0.24999, -0.0}), VoxelIndex(0, 0, 0));
}

TEST(VoxelGrid, IsRelativeToItsOrigin) {
  VoxelGrid grid;
  grid.voxel_size_m = 0.5;
  grid.origin_m = {10.0, -10.0, 0.25};
  EXPECT_EQ(grid.voxel_of({10.0, -10.0, 0.25}), VoxelIndex(0, 0, 0));
  EXPECT_EQ(grid.voxel_of({10.25, -10.25, 0.0}), VoxelIndex(1, -1, -1));
  EXPECT_EQ(grid.center_m({2, -2, 1}), Eigen::Vector3d(11.0, -11.0, 0.75));
}

TEST(VoxelGrid, EveryCentreLiesInItsVoxel) {
  VoxelGrid grid;
  grid.voxel_size_m = 0.1;
  grid.origin_m = {0.03, -7.7, 123.4};
  for (int i = -5000; i <= 5000; ++i) {
    const VoxelIndex voxel(i, 3 * i, -i);
    ASSERT_EQ(grid.voxel_of(grid.center_m(voxel)), voxel);
  }
}

TEST(MapWindow, ContainsItsFirstVoxelAndNotItsEnd) {
  const MapWindow window = {{-3, 0, 5}, {4, 1, 2}};
  EXPECT_TRUE(window.contains({-3, 0, 5}));
  EXPECT_TRUE(window.contains({0, 0, 6}));
  EXPECT_FALSE(window.contains({1, 0, 6}));
  EXPECT_FALSE(window.contains({0, 1, 6}));
  EXPECT_FALSE(window.contains({0, -1, 6}));
  EXPECT_FALSE(window.contains({-4, 0, 5}));
  EXPECT_FALSE(window.contains({0, 0, 7}));
}

}  // namespace
}  // namespace nextview
