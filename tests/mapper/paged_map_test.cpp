// A map of which only a window lies open in memory, against one in one buffer: the same bit for
// bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <numbers>

#include "mapper/map_builder.h"
#include "mapper/paged_map_builder.h"
#include "tests/mapper/plain_digest.h"
#include "tests/mapper/same_map.h"
#include "tests/mapper/small_world.h"

namespace nextview {
namespace {

// What expect_equal_maps asks of a map.
struct WholeOf {
  const PagedMapBuilder& builder;

  const MapWindow& window() const { return builder.extent(); }
  Label label(const VoxelIndex& voxel) const { return builder.label(voxel); }
  const SurfaceVoxel* surface(const VoxelIndex& voxel) const { return builder.surface(voxel); }
};

void expect_equal_counts(const FoldCounts& a, const FoldCounts& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.points_outside, b.points_outside);
  EXPECT_EQ(a.no_returns, b.no_returns);
  EXPECT_EQ(a.invalid, b.invalid);
  EXPECT_EQ(a.newly_occupied, b.newly_occupied);
}

TEST(PagedMap, IsTheMapOfOneBufferOverRandomWorldsAndViews) {
  int views = 0;
  std::size_t aside = 0;
  for (int n = 0; n < 600; ++n) {
    SCOPED_TRACE("world " + std::to_string(n));
    RandomStream random(n, 3, 1, RandomPurpose::RangeNoise);
    const SmallWorld world = random_small_world(random);
    VoxelIndex window;
    for (int axis = 0; axis < 3; ++axis) window[axis] = uniform_int(random, 1, 24);
    PagedMapBuilder paged(world.grid, world.window, window);
    MapBuilder builder(world.grid, world.window);
    ReferenceMapUpdate reference(world.grid, world.window);
    for (int view = uniform_int(random, 1, 6); view > 0; --view) {
      const RangeImage image = random_view(world, random_sensor(random), random);
      expect_equal_counts(paged.fold(image), builder.fold(image));
      reference.fold(image);
      expect_equal_maps(WholeOf{paged}, reference);
      expect_equal_statistics(paged.statistics(), builder.statistics());
      if (random.below(2) == 0) {  // also hashed late, over several folds
        EXPECT_EQ(paged.digest(), builder.digest());
      }
      if (HasFailure()) return;
      ++views;
      aside += paged.blocks_aside();
    }
    EXPECT_EQ(paged.digest(), builder.digest());
    EXPECT_EQ(paged.digest(), plain_digest(reference, world.window));
  }
  EXPECT_GT(views, 1500);
  EXPECT_GT(aside, 5000u);
  std::cout << views << " views, " << aside << " blocks aside after them\n";
}

class PagedMapAlong : public testing::TestWithParam<int> {};

// There and back, so that everything it has left comes back.
TEST_P(PagedMapAlong, FollowsASensorAHundredMetresAndBack) {
  const int axis = GetParam();
  const VoxelGrid grid{0.25, Eigen::Vector3d::Zero()};
  MapWindow extent{VoxelIndex::Constant(-13), VoxelIndex::Constant(27)};
  extent.min[axis] = -24;
  extent.size[axis] = 448;
  const AnalyticWorld world = passage(axis);
  const RayTable rays = make_ray_table(TiltedLineScan::with_aperture(24, 18, 1.4));
  PagedMapBuilder paged(grid, extent, VoxelIndex::Constant(32));
  MapBuilder builder(grid, extent);
  int images = 0;
  std::size_t most_bytes = 0;
  const auto scan_at = [&](int along) {
    SensorPose pose;
    pose.position_m[axis] = 0.25 * along;
    pose.pan_rad = 2.1 * images;
    pose.tilt_rad = 0.6 * (images % 5 - 2);
    const RangeImage image = scan_world(world, rays, {0.05, 4.0}, pose);
    expect_equal_counts(paged.fold(image), builder.fold(image));
    ASSERT_EQ(paged.digest(), builder.digest()) << "at " << along;
    expect_equal_statistics(paged.statistics(), builder.statistics());
    ASSERT_TRUE(paged.window().contains(grid.voxel_of(pose.position_m)));
    most_bytes = std::max(most_bytes, paged.memory_bytes());
    ++images;
  };
  for (int along = 0; along <= 400; along += 4) ASSERT_NO_FATAL_FAILURE(scan_at(along));
  const VoxelIndex far = paged.window().min;
  for (int along = 396; along >= 0; along -= 4) ASSERT_NO_FATAL_FAILURE(scan_at(along));
  EXPECT_EQ(images, 201);
  EXPECT_GT(far[axis] - paged.window().min[axis], 350);
  EXPECT_EQ(paged.window().size.prod(), 32 * 32 * 32);
  EXPECT_GT(paged.blocks_aside(), 500u);
  EXPECT_LT(most_bytes, builder.memory_bytes());
  std::cout << paged.blocks_aside() << " blocks aside; " << most_bytes / 1000
            << " KB at most, in one "
            << "buffer " << builder.memory_bytes() / 1000 << " KB\n";
}

INSTANTIATE_TEST_SUITE_P(EachAxis, PagedMapAlong, testing::Values(0, 1, 2));

// A wall ahead, a window of one block about the sensor: the wall and what it hides lie outside.
TEST(PagedMap, MarksFarFromItsWindow) {
  const VoxelGrid grid{0.1, Eigen::Vector3d::Zero()};
  const MapWindow extent{{-4, -4, -4}, {8, 40, 8}};
  PagedMapBuilder paged(grid, extent, {8, 8, 8});
  RangeImage image;
  image.rays.column_sin = image.rays.row_sin = {0.0, -0.0};
  image.rays.column_cos = image.rays.row_cos = {1.0, 1.0};
  image.range_m.assign(4, 2.0f);
  const FoldCounts counts = paged.fold(image);
  EXPECT_EQ(counts.points, 4);
  EXPECT_EQ(counts.newly_occupied, 1);
  for (int j = 0; j < 20; ++j) EXPECT_EQ(paged.label({0, j, 0}), Label::Empty) << j;
  EXPECT_EQ(paged.label({0, 20, 0}), Label::Occupied);
  for (int j = 21; j < 36; ++j) EXPECT_EQ(paged.label({0, j, 0}), Label::Occluded) << j;
  EXPECT_EQ(paged.label({0, 36, 0}), Label::Unmarked);
  EXPECT_EQ(paged.window(), (MapWindow{{0, 0, 0}, {8, 8, 8}}));
  const MapStatistics statistics = paged.statistics();
  EXPECT_EQ(statistics.voxels[static_cast<std::size_t>(Label::Empty)], 20);
  EXPECT_EQ(statistics.voxels[static_cast<std::size_t>(Label::Occluded)], 15);
  EXPECT_EQ(statistics.voxels[static_cast<std::size_t>(Label::Unmarked)], 8 * 40 * 8 - 36);
  EXPECT_EQ(statistics.occupied_faces, 1);
  EXPECT_GT(paged.blocks_aside(), 3u);
}

TEST(PagedMap, WantsAnExtentAndAWindow) {
  const auto make = [](const VoxelIndex& extent, const VoxelIndex& window, double voxel_size_m) {
    return PagedMapBuilder({voxel_size_m, Eigen::Vector3d::Zero()}, {VoxelIndex::Zero(), extent},
                           window);
  };
  EXPECT_NO_THROW(make({10'000, 1, 1}, {8, 8, 8}, 0.1));
  EXPECT_THROW(make({0, 8, 8}, {8, 8, 8}, 0.1), std::invalid_argument);
  EXPECT_THROW(make({16'385, 8, 8}, {8, 8, 8}, 0.1), std::invalid_argument);
  EXPECT_THROW(make({2048, 2048, 512}, {8, 8, 8}, 0.1), std::invalid_argument);
  EXPECT_THROW(make({8, 8, 8}, {8, 0, 8}, 0.1), std::invalid_argument);
  EXPECT_THROW(make({8, 8, 8}, {8, 8, 8}, 0.0), std::invalid_argument);
}

TEST(PagedMap, RefusesAnImageFromOutsideAndStaysAsItIs) {
  RandomStream random(1, 3, 2, RandomPurpose::RangeNoise);
  const SmallWorld world = random_small_world(random);
  PagedMapBuilder paged(world.grid, world.window, {8, 8, 8});
  RangeImage image = random_view(world, TiltedLineScan::paper(), random);
  paged.fold(image);
  const std::string digest = paged.digest();
  image.position_m = world.corner_m(1) + Eigen::Vector3d::Constant(world.grid.voxel_size_m);
  EXPECT_THROW(paged.fold(image), std::invalid_argument);
  EXPECT_EQ(paged.digest(), digest);
}

}  // namespace
}  // namespace nextview
