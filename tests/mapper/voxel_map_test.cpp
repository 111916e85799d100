#include "mapper/voxel_map.h"

#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "tests/mapper/analytic_world.h"

namespace nextview {
namespace {

VoxelMap small_map(const MapWindow& window) { return VoxelMap(VoxelGrid(), window); }

TEST(VoxelMap, IsUnmarkedAtFirstAndOutside) {
  VoxelMap map = small_map({{-3, 0, 5}, {5, 6, 7}});
  EXPECT_EQ(map.label({-3, 0, 5}), Label::Unmarked);
  map.set_label({1, 5, 11}, Label::Empty);
  EXPECT_EQ(map.label({1, 5, 11}), Label::Empty);
  EXPECT_EQ(map.label({2, 5, 11}), Label::Unmarked);
  EXPECT_EQ(map.surface({1, 5, 11}), nullptr);
}

TEST(VoxelMap, SidesArePowersOfTwo) {
  const VoxelMap map = small_map({{0, 0, 0}, {64, 48, 5}});
  EXPECT_EQ(map.sides(), (std::array<int, 3>{64, 64, 8}));
  EXPECT_EQ(map.labels().size(), 64u * 64u * 8u);
}

TEST(VoxelMap, SizesThatCannotBeAreRefused) {
  EXPECT_THROW(small_map({{0, 0, 0}, {0, 4, 4}}), std::invalid_argument);
  EXPECT_THROW(small_map({{0, 0, 0}, {4, 4097, 4}}), std::invalid_argument);
  EXPECT_THROW(small_map({{0, 0, 0}, {4096, 4096, 4096}}), std::invalid_argument);
  EXPECT_THROW(VoxelMap({-0.1, {0, 0, 0}}, MapWindow()), std::invalid_argument);
}

TEST(VoxelMap, FollowsASensorFarAlongAnAxisAndBackWithoutMovingData) {
  // What the map must hold: what was written, as long as it has stayed in the window.
  std::map<std::tuple<int, int, int>, Label> expected;
  const auto key = [](const VoxelIndex& i) { return std::make_tuple(i[0], i[1], i[2]); };
  RandomStream random(1, 1, 1, RandomPurpose::RangeNoise);
  VoxelMap map = small_map({{0, 0, 0}, {16, 12, 8}});
  const Label* const memory = map.labels().data();
  std::int64_t compared = 0;
  const auto visit = [&](const VoxelIndex& new_min) {
    const VoxelIndex old_min = map.window().min;
    // A voxel that stays keeps its slot.
    const VoxelIndex stays = old_min.cwiseMax(new_min);
    const std::size_t slot = map.slot(stays);
    map.move_window(new_min);
    EXPECT_EQ(map.slot(stays), slot);
    EXPECT_EQ(map.labels().data(), memory);
    std::erase_if(expected, [&](const auto& entry) {
      const auto [i, j, k] = entry.first;
      return !map.contains({i, j, k});
    });
    for (int n = 0; n < 40; ++n) {
      const VoxelIndex voxel =
          new_min + VoxelIndex(uniform_int(random, 0, 15), uniform_int(random, 0, 11),
                               uniform_int(random, 0, 7));
      const auto label = static_cast<Label>(1 + random.below(4));
      map.set_label(voxel, label);
      expected[key(voxel)] = label;
      if (label == Label::Occupied) map.surface_at(voxel).quality = 7;
    }
    for (int k = -2; k < 10; ++k) {
      for (int j = -2; j < 14; ++j) {
        for (int i = -2; i < 18; ++i) {
          const VoxelIndex voxel = new_min + VoxelIndex(i, j, k);
          const auto found = expected.find(key(voxel));
          ASSERT_EQ(map.label(voxel), found == expected.end() ? Label::Unmarked : found->second);
          ++compared;
        }
      }
    }
  };
  for (int i = 0; i <= 300; i += 3) visit({i, i % 5, 0});
  for (int i = 300; i >= -100; i -= 3) visit({i, 0, -(i % 4)});
  visit({5000, 5000, 5000});  // nothing stays
  visit({-5000, 5000, 5000});
  EXPECT_GT(compared, 800'000);
}

TEST(VoxelMap, SurfacesLeftBehindAreForgotten) {
  VoxelMap map = small_map({{0, 0, 0}, {16, 16, 16}});
  map.set_label({0, 3, 3}, Label::Occupied);
  map.surface_at({0, 3, 3}).quality = 11;
  map.set_label({15, 3, 3}, Label::Occupied);
  map.surface_at({15, 3, 3}).quality = 12;
  map.move_window({1, 0, 0});
  EXPECT_EQ(map.surface({0, 3, 3}), nullptr);
  EXPECT_EQ(map.surface({16, 3, 3}), nullptr);  // shares the slot of the one left behind
  EXPECT_EQ(map.label({16, 3, 3}), Label::Unmarked);
  ASSERT_NE(map.surface({15, 3, 3}), nullptr);
  EXPECT_EQ(map.surface({15, 3, 3})->quality, 12);
}

TEST(SurfaceVoxel, MeanNormalIsAUnitVectorOrZero) {
  SurfaceVoxel voxel;
  EXPECT_TRUE(voxel.mean_normal().isZero());
  voxel.normal_sum = {0, -3 * SurfaceVoxel::kNormalUnit, 4 * SurfaceVoxel::kNormalUnit};
  EXPECT_TRUE(voxel.mean_normal().isApprox(Eigen::Vector3d(0.0, -0.6, 0.8)));
}

}  // namespace
}  // namespace nextview
