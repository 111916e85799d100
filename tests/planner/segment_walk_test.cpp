#include "planner/segment_walk.h"

#include <gtest/gtest.h>

#include "sensor/random_stream.h"

namespace nextview {
namespace {

using Eigen::Vector3d;

TEST(VoxelsAlong, PassesThroughFaces) {
  const VoxelGrid grid{1.0, Vector3d::Zero()};
  const std::vector<VoxelIndex> expected = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {2, 1, 0}};
  EXPECT_EQ(voxels_along(grid, {0.0, 0.0, 0.0}, {2.0, 1.2, 0.0}), expected);
  EXPECT_EQ(voxels_along(grid, {0.1, 0.0, 0.0}, {-0.2, 0.0, 0.3}).size(), 1u);
}

// Every voxel that points sampled densely on a segment fall in must be in the list.
TEST(VoxelsAlong, LeavesOutNoVoxelTheSegmentPassesThrough) {
  const VoxelGrid grid{0.1, Vector3d(0.03, -0.02, 0.01)};
  RandomStream random(1, 1, 1, RandomPurpose::InitialSimplex);
  const auto point = [&random]() -> Vector3d {
    return (Vector3d(random.uniform(), random.uniform(), random.uniform()) -
            Vector3d::Constant(0.5)) *
           4.0;
  };
  int segments = 0;
  for (; segments < 2000; ++segments) {
    const Vector3d from = point();
    Vector3d to = point();
    if (segments % 4 == 0) to[segments % 3] = from[segments % 3];  // along a plane of the axes
    const auto voxels = voxels_along(grid, from, to);
    ASSERT_EQ(voxels.front(), grid.voxel_of(from));
    ASSERT_EQ(voxels.back(), grid.voxel_of(to));
    for (std::size_t i = 1; i < voxels.size(); ++i) {
      ASSERT_EQ((voxels[i] - voxels[i - 1]).cwiseAbs().sum(), 1);
    }
    std::size_t at = 0;
    for (int sample = 0; sample <= 400; ++sample) {
      const VoxelIndex voxel = grid.voxel_of(from + (sample / 400.0) * (to - from));
      while (at < voxels.size() && voxels[at] != voxel) ++at;
      ASSERT_LT(at, voxels.size());
    }
  }
  EXPECT_EQ(segments, 2000);
}

}  // namespace
}  // namespace nextview
