// Where rays leave a map's window: worked out by hand, and against a walk along the ray.
#include "mapper/window_limit.h"

#include <gtest/gtest.h>

#include "tests/mapper/analytic_world.h"

namespace nextview {
namespace {

const MapWindow kWindow = {{-1, -1, -1}, {3, 8, 3}};  // x, z in -1.5 ... 1.5 m; y in -1.5 ... 6.5 m

VoxelIndex limit(const Eigen::Vector3d& position_m, const Eigen::Vector3d& direction) {
  return limit_of_ray({1.0, Eigen::Vector3d::Zero()}, kWindow, position_m, direction);
}

TEST(LimitOfRay, IsTheOutermostVoxelAlongAnAxis) {
  EXPECT_EQ(limit({0, 0, 0}, {0, 1, 0}), VoxelIndex(0, 6, 0));
  EXPECT_EQ(limit({0, 0, 0}, {0, -1, 0}), VoxelIndex(0, -1, 0));
  EXPECT_EQ(limit({0.6, 3.2, -1}, {-1, 0, 0}), VoxelIndex(-1, 3, -1));
  EXPECT_EQ(limit({0.6, 3.2, -1}, {0.0, -0.0, 1}), VoxelIndex(1, 3, 1));
}

TEST(LimitOfRay, LiesAlongTheFaceTheRayComesToFirst) {
  // x = 1.5 is met after 2.5 m of y, which is y = 2.5 + 0.2 = 2.7.
  EXPECT_EQ(limit({0, 0.2, 0}, Eigen::Vector3d(3, 5, 0).normalized()), VoxelIndex(1, 3, 0));
  // The other way: x = -1.5 would be met at y = -2.3, but y = -1.5 is met first, at x = -1.02.
  EXPECT_EQ(limit({0, 0.2, 0}, Eigen::Vector3d(-3, -5, 0).normalized()), VoxelIndex(-1, -1, 0));
}

TEST(LimitOfRay, OfARayThroughACornerIsTheCornersVoxel) {
  EXPECT_EQ(limit({0, 5, 0}, Eigen::Vector3d(1, 1, 1).normalized()), VoxelIndex(1, 6, 1));
  EXPECT_EQ(limit({0, 0, 0}, Eigen::Vector3d(-1, -1, -1).normalized()), VoxelIndex(-1, -1, -1));
}

TEST(LimitOfRay, OfARayWithinAFaceOfTheWindowIsWhereTheFaceEnds) {
  EXPECT_EQ(limit({1.5, 0, 0}, {0, 1, 0}), VoxelIndex(1, 6, 0));
  EXPECT_EQ(limit({-1.5, 0, 1.5}, {0, 1, 0}), VoxelIndex(-1, 6, 1));
}

// A little before the limit the ray is in the limit's voxel or, where it cuts a corner there, in
// one of its neighbours; and a little after it is outside.
TEST(LimitOfRay, IsWhereAWalkAlongTheRayLeavesTheWindow) {
  int in_the_same_voxel = 0;
  constexpr int kRays = 20'000;
  for (int n = 0; n < kRays; ++n) {
    RandomStream random(n, 1, 1, RandomPurpose::RangeNoise);
    VoxelGrid grid = {uniform(random, 0.02, 0.3), Eigen::Vector3d::Zero()};
    MapWindow window;
    for (int axis = 0; axis < 3; ++axis) {
      grid.origin_m[axis] = uniform(random, -5.0, 5.0);
      window.min[axis] = uniform_int(random, -40, 40);
      window.size[axis] = uniform_int(random, 1, 60);
    }
    Eigen::Vector3d position_m, direction;
    for (int axis = 0; axis < 3; ++axis) {
      const WindowExtent extent = window_extent(grid, window, axis);
      position_m[axis] = uniform(random, extent.low_m, extent.high_m);
      direction[axis] = uniform(random, -1.0, 1.0);
    }
    direction.normalize();
    const double step_m = 1e-3 * grid.voxel_size_m;
    double length_m = 0.0;
    while (window.contains(grid.voxel_of(position_m + (length_m + step_m) * direction))) {
      length_m += step_m;
    }
    const VoxelIndex last = grid.voxel_of(position_m + length_m * direction);
    const VoxelIndex found = limit_of_ray(grid, window, position_m, direction);
    ASSERT_TRUE(window.contains(found));
    ASSERT_LE((found - last).cwiseAbs().maxCoeff(), 1) << "ray " << n;
    in_the_same_voxel += found == last;
  }
  EXPECT_GT(in_the_same_voxel, kRays * 99 / 100);
}

}  // namespace
}  // namespace nextview
