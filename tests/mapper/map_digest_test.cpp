#include "mapper/map_digest.h"

#include <gtest/gtest.h>

#include <set>

#include "mapper/map_builder.h"
#include "tests/mapper/analytic_world.h"

namespace nextview {
namespace {

// A map of voxels written by a fixed rule, so that its digest depends on integers alone.
void write_pattern(VoxelMap& map) {
  for (int k = 0; k < 20; ++k) {
    for (int j = -10; j < 10; ++j) {
      for (int i = -5; i < 15; ++i) {
        const int mixed = (i * 7 + j * 13 + k * 29) % 11;
        const auto label = static_cast<Label>(std::abs(mixed) % 5);
        map.set_label({i, j, k}, label);
        if (label != Label::Occupied) continue;
        SurfaceVoxel& surface = map.surface_at({i, j, k});
        surface.normal_sum = {1000 * i, -2000 * j, std::int64_t{3000} * k};
        surface.normal_count = static_cast<std::uint32_t>(i + 6);
        surface.quality = static_cast<std::uint16_t>(100 * k + i + 5);
      }
    }
  }
}

VoxelMap pattern_map(const MapWindow& window) {
  VoxelMap map(VoxelGrid(), window);
  write_pattern(map);
  return map;
}

const MapWindow kSnug = {{-5, -10, 0}, {20, 20, 20}};

TEST(MapDigest, IsTheSameFromEveryCompiler) {
  EXPECT_EQ(map_digest(pattern_map(kSnug)), "b955c08fd05b062e7490f9e03b4f429d");
}

TEST(MapDigest, OfAnEmptyMapIsTheHashOfNothing) {
  EXPECT_EQ(map_digest(VoxelMap(VoxelGrid(), kSnug)), "99aa06d3014798d86001c324468d497f");
}

TEST(MapDigest, DoesNotDependOnTheWindow) {
  const std::string digest = map_digest(pattern_map(kSnug));
  EXPECT_EQ(map_digest(pattern_map({{-5, -10, 0}, {32, 32, 32}})), digest);
  EXPECT_EQ(map_digest(pattern_map({{-17, -12, -9}, {32, 22, 29}})), digest);
  EXPECT_EQ(map_digest(pattern_map({{-100, -100, -100}, {128, 128, 128}})), digest);
  VoxelMap moved(VoxelGrid(), {{900, 900, 900}, {32, 32, 32}});
  moved.set_label({901, 902, 903}, Label::Empty);
  moved.move_window({-9, -15, -3});
  write_pattern(moved);
  EXPECT_EQ(map_digest(moved), digest);
}

TEST(MapDigest, DependsOnWhereTheVoxelsAre) {
  std::set<std::string> digests;
  for (int i = 0; i < 64; ++i) {
    VoxelMap map(VoxelGrid(), {{0, 0, 0}, {64, 8, 8}});
    map.set_label({i, 0, 0}, Label::Empty);
    digests.insert(map_digest(map));
  }
  EXPECT_EQ(digests.size(), 64u);
}

TEST(MapDigest, ChangesWithAnyVoxel) {
  VoxelMap map = pattern_map(kSnug);
  std::set<std::string> digests = {map_digest(map)};
  std::size_t changes = 0;
  for (int n = 0; n < 8000; n += 37) {
    const VoxelIndex voxel(-5 + n % 20, -10 + n / 20 % 20, n / 400);
    if (map.label(voxel) == Label::Occupied) {
      SurfaceVoxel& surface = map.surface_at(voxel);
      switch (n % 5) {
        case 0:
          surface.normal_sum[0] += 1;
          break;
        case 1:
          surface.normal_sum[1] -= 1;
          break;
        case 2:
          surface.normal_sum[2] += std::int64_t{1} << 40;
          break;
        case 3:
          surface.normal_count += 1;
          break;
        default:
          surface.quality ^= 0x8000;
          break;
      }
    } else {
      map.set_label(voxel, static_cast<Label>((static_cast<int>(map.label(voxel)) + 1) % 4));
    }
    ++changes;
    digests.insert(map_digest(map));
    ASSERT_EQ(digests.size(), changes + 1) << voxel.transpose();
  }
  EXPECT_GT(changes, 200u);
}

TEST(MapDigest, KeptUpToDateEqualsMadeFromNothing) {
  VoxelMap map(VoxelGrid(), kSnug);
  const MapBlocks blocks(map);
  MapDigest digest(blocks);
  RandomStream random(1, 1, 1, RandomPurpose::RangeNoise);
  EXPECT_EQ(digest.digest(map, blocks), map_digest(map));
  for (int n = 0; n < 500; ++n) {
    for (std::uint32_t m = random.below(4); m > 0; --m) {
      const VoxelIndex voxel(uniform_int(random, -5, 14), uniform_int(random, -10, 9),
                             uniform_int(random, 0, 19));
      map.set_label(voxel, static_cast<Label>(random.below(5)));
      if (map.label(voxel) == Label::Occupied) map.surface_at(voxel).quality += 1;
      digest.invalidate(blocks.block_of(map.slot(voxel)));
    }
    ASSERT_EQ(digest.digest(map, blocks), map_digest(map));
  }
}

// A whole fold in arithmetic whose inputs are exact in binary: a change of compiler, flags or
// instruction set must not change a bit.
TEST(MapDigest, OfAFoldedImageIsTheSameFromEveryCompiler) {
  RangeImage image;
  // Angles whose sines and cosines are ratios: (1 - t^2, 2t) / (1 + t^2), rounded once each.
  for (int u = 0; u < 48; ++u) {
    const double t = (24 - u) / 96.0;
    image.rays.column_sin.push_back(2.0 * t / (1.0 + t * t));
    image.rays.column_cos.push_back((1.0 - t * t) / (1.0 + t * t));
  }
  for (int v = 0; v < 32; ++v) {
    const double t = (16 - v) / 96.0;
    image.rays.row_sin.push_back(2.0 * t / (1.0 + t * t));
    image.rays.row_cos.push_back((1.0 - t * t) / (1.0 + t * t));
  }
  image.world_from_sensor << 0.8, -0.6, 0.0, 0.6, 0.8, 0.0, 0.0, 0.0, 1.0;
  image.position_m = {0.125, -0.25, 0.5};
  for (int n = 0; n < 48 * 32; ++n) {
    image.range_m.push_back(2.0f + static_cast<float>(n * n % 257) / 1024.0f +
                            (n % 48 > 30 ? 0.5f : 0.0f));
  }
  MapBuilder builder(VoxelGrid(), {{-32, -32, -16}, {64, 64, 40}});
  builder.fold(image);
  EXPECT_EQ(builder.digest(), "eacfdc03738c269bb0f6d46e4f4e9ddd");
}

}  // namespace
}  // namespace nextview
