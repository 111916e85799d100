// Arrays of which only what is written to takes memory: they read as if filled, and what they take
// is counted.
#include "mapper/lazy_array.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <iostream>
#include <utility>
#include <vector>

#include "mapper/map_builder.h"
#include "tests/mapper/analytic_world.h"

namespace nextview {
namespace {

constexpr std::size_t kPage = 4096;

TEST(LazyArray, BeginsWithOneValueWhateverItsSize) {
  for (const std::size_t size : {0u, 1u, 1000u, (1u << 18) - 1, 1u << 18, 3'000'001u}) {
    for (const std::uint32_t value : {0u, 0xffffffffu, 0x12345678u}) {
      const LazyArray<std::uint32_t> array(size, value);
      ASSERT_EQ(array.size(), size);
      EXPECT_TRUE(std::ranges::all_of(array, [&](std::uint32_t entry) { return entry == value; }))
          << size << " of " << value;
    }
  }
}

TEST(LazyArray, TakesMemoryOnlyForPagesThatAreWrittenTo) {
  for (const std::uint8_t value : {std::uint8_t{0}, std::uint8_t{96}}) {
    LazyArray<std::uint8_t> array(std::size_t{1} << 32, value);
    const std::size_t pattern = array.memory_bytes();
    EXPECT_LE(pattern, value == 0 ? 0 : array.size() / 256);
    std::size_t sum = 0;
    for (std::size_t n = 0; n < array.size(); n += std::size_t{1} << 22) sum += array[n];
    EXPECT_EQ(sum, 1024u * value);
    EXPECT_EQ(array.memory_bytes(), pattern) << "for having been read";
    for (std::size_t n = 0; n < 100; ++n) array[n * 7 * kPage + n] = 5;
    for (std::size_t n = 0; n < 100; ++n) array[n * 7 * kPage + n + 1] = 6;
    EXPECT_EQ(array.memory_bytes(), pattern + 100 * kPage);
    EXPECT_EQ(array[99 * 7 * kPage + 99], 5);
    EXPECT_EQ(array[99 * 7 * kPage + 98], value);
  }
}

TEST(LazyArray, BeginsWithPatternsOneAfterTheOther) {
  std::vector<std::byte> pattern(1 << 16);
  for (std::size_t n = 0; n < pattern.size(); ++n) pattern[n] = static_cast<std::byte>(n * 31 >> 4);
  const std::vector<std::byte> nine(1, std::byte{9});
  // Not all whole pages, and far below a page; all are read the same.
  for (const std::size_t first : {std::size_t{1} << 16, std::size_t{100}}) {
    for (const std::size_t repeats : {1u, 3u, 700u}) {
      const LazyPages::Stretch stretches[] = {
          {nine, first}, {pattern, repeats * pattern.size()}, {nine, 4099}};
      const LazyArray<std::uint8_t> array(stretches);
      ASSERT_EQ(array.size(), first + repeats * pattern.size() + 4099);
      for (std::size_t n = 0; n < array.size(); ++n) {
        const bool in_pattern = n >= first && n < array.size() - 4099;
        const auto expected =
            static_cast<std::uint8_t>(in_pattern ? pattern[(n - first) % pattern.size()] : nine[0]);
        ASSERT_EQ(array[n], expected) << n;
      }
    }
  }
}

TEST(LazyArray, MovesWithItsContent) {
  for (const std::size_t size : {std::size_t{10}, std::size_t{1} << 22}) {
    LazyArray<std::uint8_t> a(size, 3);
    a[7] = 1;
    LazyArray<std::uint8_t> b = std::move(a);
    EXPECT_EQ(b.size(), size);
    EXPECT_EQ(b[7], 1);
    EXPECT_EQ(b[8], 3);
    b = LazyArray<std::uint8_t>(size + 1, 4);
    EXPECT_EQ(b.size(), size + 1);
    EXPECT_EQ(b[7], 4);
  }
}

// The same view in the middle of workspaces of which the larger is a hundred times the other.
// Nothing is hit, for what is hidden reaches to the limit of the workspace and would be another.
TEST(LazyArray, LetsAMapCostWhatHasBeenSeenOfIt) {
  const VoxelGrid grid{0.1, Eigen::Vector3d::Zero()};
  const AnalyticWorld world;
  const auto bytes = [&](int half_side) {
    MapBuilder builder(grid, {VoxelIndex(-half_side, -half_side, -50),
                              VoxelIndex(2 * half_side, 2 * half_side, 100)});
    SensorPose pose;
    const RayTable rays = make_ray_table(SphericalScanner{64, 32, 6.283, 1.7});
    RangeImage image = scan_world(world, rays, {0.05, 4.0}, pose);
    builder.fold(image);
    builder.digest();
    return builder.memory_bytes();
  };
  const std::size_t of_20_m = bytes(100);
  const std::size_t of_200_m = bytes(1000);  // 537 million slots
  std::cout << of_20_m << " bytes of 20 m x 20 m x 10 m, " << of_200_m << " of 200 m x 200 m\n";
  EXPECT_LT(of_200_m, std::size_t{30} << 20);
}

}  // namespace
}  // namespace nextview
