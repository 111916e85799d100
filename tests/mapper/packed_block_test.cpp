#include "mapper/packed_block.h"

#include <gtest/gtest.h>

#include <iostream>

#include "tests/mapper/analytic_world.h"

namespace nextview {
namespace {

bool same(const BlockLabels& a, const BlockLabels& b) {
  return a.empty == b.empty && a.occupied == b.occupied && a.hidden == b.hidden &&
         a.occlusion_plane == b.occlusion_plane;
}

TEST(PackedBlock, OfOneLabelKeepsNoWord) {
  BlockLabels labels{};
  EXPECT_EQ(PackedBlock(labels).memory_bytes(), 0u);
  EXPECT_TRUE(same(PackedBlock(labels).labels(), labels));
  EXPECT_TRUE(same(PackedBlock().labels(), labels));
  labels.empty.fill(~std::uint64_t{0});
  EXPECT_EQ(PackedBlock(labels).memory_bytes(), 0u);
  EXPECT_TRUE(same(PackedBlock(labels).labels(), labels));
}

// A floor: one layer Occupied, Empty above it, and below it hidden.
TEST(PackedBlock, OfWholeLayersKeepsNoWord) {
  BlockLabels labels{};
  for (std::size_t z = 0; z < 8; ++z) {
    (z < 3 ? labels.hidden : z == 3 ? labels.occupied : labels.empty)[z] = ~std::uint64_t{0};
  }
  EXPECT_EQ(PackedBlock(labels).memory_bytes(), 0u);
  EXPECT_TRUE(same(PackedBlock(labels).labels(), labels));
}

TEST(PackedBlock, KeepsTheWordsThatAreMixed) {
  BlockLabels labels{};
  labels.empty.fill(~std::uint64_t{0});
  labels.empty[5] &= ~std::uint64_t{1};  // one voxel of one layer
  labels.occupied[5] = 1;
  EXPECT_EQ(PackedBlock(labels).memory_bytes(), 2 * sizeof(std::uint64_t));
  EXPECT_TRUE(same(PackedBlock(labels).labels(), labels));
}

TEST(PackedBlock, ComesBackBitForBit) {
  RandomStream random(1, 1, 1, RandomPurpose::RangeNoise);
  std::size_t kept = 0;
  for (int n = 0; n < 20'000; ++n) {
    BlockLabels labels{};
    for (BlockBits* const set :
         {&labels.empty, &labels.occupied, &labels.hidden, &labels.occlusion_plane}) {
      for (std::uint64_t& word : *set) {
        const std::uint64_t mixed = std::uint64_t{random.below(0xffffffff)} << 32 | random.below(7);
        const std::uint64_t choices[] = {0, ~std::uint64_t{0}, mixed, std::uint64_t{1} << 63};
        word = choices[random.below(4)];
      }
    }
    const PackedBlock packed(labels);
    ASSERT_TRUE(same(packed.labels(), labels)) << n;
    kept += packed.memory_bytes();
  }
  EXPECT_GT(kept, 20'000u * 12 * 8);
  EXPECT_LT(kept, 20'000u * 20 * 8);
}

}  // namespace
}  // namespace nextview
