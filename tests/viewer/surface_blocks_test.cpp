#include "viewer/surface_blocks.h"

#include <gtest/gtest.h>

namespace nextview {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// The block of 8^3 voxels that begins at the origin, and some of its neighbours.
VoxelMap small_map() { return VoxelMap(VoxelGrid{}, MapWindow{{0, 0, 0}, {16, 8, 8}}); }

TEST(SurfaceBlocks, AreEightBytesAVoxel) {
  VoxelMap map = small_map();
  map.set_label({1, 2, 3}, Label::Occupied);
  SurfaceVoxel& surface = map.surface_at({1, 2, 3});
  surface.normal_sum = {0, -3 * SurfaceVoxel::kNormalUnit, 0};
  surface.normal_count = 3;
  surface.quality = 65535 / 5;  // 0.2, which is 51 / 255
  map.set_label({7, 7, 7}, Label::OcclusionPlane);
  map.set_label({0, 0, 0}, Label::Occupied);  // no point of it had a normal
  map.set_label({2, 0, 0}, Label::Empty);
  map.set_label({3, 0, 0}, Label::Occluded);
  map.set_label({8, 0, 0}, Label::Occupied);  // in the next block
  const MapBlocks blocks(map);
  std::uint32_t first = 0;
  while (blocks.coordinate(first) != VoxelIndex(0, 0, 0)) ++first;
  EXPECT_EQ(surface_of_block(map, blocks, first), (Bytes{0,
                                                         0,
                                                         0,
                                                         0,
                                                         0,
                                                         0,
                                                         0,
                                                         0,  //
                                                         1 + 8 * 2 + 64 * 3 - 0,
                                                         0,
                                                         0,
                                                         0,  // 209
                                                         0,
                                                         0x81,
                                                         0,
                                                         51,  // -127
                                                         0xff,
                                                         0x03,
                                                         0,
                                                         0,
                                                         0,
                                                         0,
                                                         0,
                                                         0}));  // 511, and bit 9
}

TEST(SurfaceBlocks, ThatHaveChangedAreNamedOnce) {
  const VoxelMap map = small_map();
  const MapBlocks blocks(map);
  const auto slot = [&map](int i, int j, int k) {
    return static_cast<std::uint32_t>(map.slot({i, j, k}));
  };
  FoldReport report;
  report.changed_slots = {slot(9, 0, 0), slot(15, 7, 7)};
  report.updated_surfaces = {slot(9, 0, 0)};
  const auto changed = changed_blocks(blocks, report);
  ASSERT_EQ(changed.size(), 1U);
  EXPECT_EQ(blocks.coordinate(changed[0]), VoxelIndex(1, 0, 0));
  report.updated_surfaces.push_back(slot(0, 0, 0));
  EXPECT_EQ(changed_blocks(blocks, report).size(), 2U);
}

}  // namespace
}  // namespace nextview
