#include "mapper/block_store.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/mapper/analytic_world.h"
#include "tests/mapper/same_map.h"

namespace nextview {
namespace {

const MapWindow kExtent{{-20, 5, 0}, {200, 100, 30}};  // 26 x 14 x 4 blocks

// Writes a voxel as a map update does.
void write(BlockStore& store, const VoxelIndex& voxel, Label label, const SurfaceVoxel& surface) {
  OpenBlock& block = store.open(voxel.unaryExpr(&block_of_index));
  const VoxelBit at(voxel);
  if (label == Label::Unmarked || label_in(block, voxel) != Label::Unmarked) return;
  BlockBits* const sets[] = {nullptr, &block.labels.hidden, &block.labels.occlusion_plane,
                             &block.labels.empty, &block.labels.occupied};
  if (label == Label::OcclusionPlane) block.labels.hidden[at.word] |= at.bit;
  if (label == Label::Occupied) {
    block.surfaces.insert(
        block.surfaces.begin() + static_cast<std::ptrdiff_t>(at.rank_in(block.labels.occupied)),
        surface);
  }
  (*sets[static_cast<int>(label)])[at.word] |= at.bit;
  block.is_marked = block.is_stale = true;
}

SurfaceVoxel random_surface(RandomStream& random) {
  SurfaceVoxel surface;
  for (std::int64_t& sum : surface.normal_sum) sum = uniform_int(random, -1'000'000, 1'000'000);
  surface.normal_count = random.below(1000);
  surface.quality = static_cast<std::uint16_t>(random.below(65536));
  return surface;
}

// Labels and surface data of all voxels, and the hash of all blocks.
struct Content {
  explicit Content(BlockStore& store) {
    for_each_voxel(kExtent, [&](const VoxelIndex& voxel) {
      labels.push_back(store.label(voxel));
      const SurfaceVoxel* const surface = store.surface(voxel);
      if (surface != nullptr) surfaces.push_back(*surface);
    });
    HashOfBlocks whole;
    store.hash(whole);
    digest = whole.hex_digits();
  }

  std::vector<Label> labels;
  std::vector<SurfaceVoxel> surfaces;
  std::string digest;
};

TEST(BlockStore, KeepsAsideWhatItsWindowLeavesAndBringsItBack) {
  BlockStore store(kExtent, {40, 40, 16});
  BlockStore all(kExtent, {208, 112, 32});  // everything stands open
  store.follow({0, 40, 10});
  RandomStream random(1, 1, 1, RandomPurpose::RangeNoise);
  for (int n = 0; n < 3000; ++n) {
    const VoxelIndex voxel(uniform_int(random, -20, 179), uniform_int(random, 5, 104),
                           uniform_int(random, 0, 29));
    const auto label = static_cast<Label>(random.below(5));
    const SurfaceVoxel surface = random_surface(random);
    write(store, voxel, label, surface);
    write(all, voxel, label, surface);
  }
  store.close_far();
  const Content before(all);
  EXPECT_GT(before.surfaces.size(), 300u);
  EXPECT_EQ(all.blocks_aside(), 0u);
  for (const VoxelIndex& at :
       {VoxelIndex(0, 40, 10), VoxelIndex(179, 104, 0), VoxelIndex(-20, 5, 29),
        VoxelIndex(90, 60, 15), VoxelIndex(0, 40, 10)}) {
    SCOPED_TRACE(testing::Message() << "about " << at.transpose());
    store.follow(at);
    EXPECT_TRUE(store.window().contains(at));
    EXPECT_EQ(store.window().size, VoxelIndex(40, 40, 16));
    EXPECT_GT(store.blocks_aside(), 500u);
    const Content content(store);
    EXPECT_EQ(content.labels, before.labels);
    EXPECT_EQ(content.digest, before.digest);
    ASSERT_EQ(content.surfaces.size(), before.surfaces.size());
    for (std::size_t n = 0; n < content.surfaces.size(); ++n) {
      ASSERT_TRUE(same_surface(&content.surfaces[n], &before.surfaces[n])) << n;
    }
  }
}

TEST(BlockStore, WhatIsOpenedElsewhereAndLeftAloneStaysAsItIs) {
  BlockStore store(kExtent, {8, 8, 8});
  RandomStream random(1, 1, 1, RandomPurpose::RangeNoise);
  write(store, {100, 50, 20}, Label::Occupied, random_surface(random));
  store.close_far();
  EXPECT_EQ(store.blocks_aside(), 1u);
  const Content before(store);
  EXPECT_EQ(store.open_marked({0, 1, 0}), nullptr);   // nothing there
  EXPECT_EQ(store.open_marked({-4, 1, 0}), nullptr);  // not in the extent
  EXPECT_NE(store.open_marked({12, 6, 2}), nullptr);  // the one
  store.close_far();
  EXPECT_EQ(store.blocks_aside(), 1u);
  EXPECT_EQ(Content(store).digest, before.digest);
  EXPECT_EQ(store.label({100, 50, 20}), Label::Occupied);
}

}  // namespace
}  // namespace nextview
