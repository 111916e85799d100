// Blocks in bits against the same blocks voxel by voxel.
#include "mapper/block_bits.h"

#include <gtest/gtest.h>

#include "mapper/voxel_map.h"
#include "tests/mapper/analytic_world.h"

namespace nextview {
namespace {

bool has(const BlockBits& bits, int x, int y, int z) {
  return bits[static_cast<std::size_t>(z)] >> (8 * x + y) & 1;
}

// A block and the blocks at its six sides, by voxel: indices -8 ... 15 on one axis at a time.
struct RandomBlocks {
  explicit RandomBlocks(RandomStream& random) {
    const std::uint32_t kinds = 1 + random.below(6);
    for (BlockRows& block : rows) {
      block = {};
      for (std::size_t n = 0; n < 512; ++n) {
        block[n % 64] |= std::uint64_t{random.below(6) < kinds ? random.below(kLabelCount) : 3}
                         << (8 * (n / 64));
      }
    }
    for (std::size_t n = 0; n < rows.size(); ++n) sort_by_label(rows[n], labels[n]);
  }
  // The label of a voxel of the middle block, or one next to it.
  int label(int x, int y, int z) const {
    std::size_t block = 6;
    for (const auto& [index, axis] : {std::pair(x, 0), std::pair(y, 1), std::pair(z, 2)}) {
      if (index < 0) block = static_cast<std::size_t>(2 * axis);
      if (index > 7) block = static_cast<std::size_t>(2 * axis + 1);
    }
    const auto row = static_cast<std::size_t>(8 * (y & 7) + (z & 7));
    return static_cast<int>(rows[block][row] >> (8 * (x & 7)) & 0xff);
  }
  int empty_neighbours(int x, int y, int z) const {
    const auto empty = [&](int i, int j, int k) {
      return label(x + i, y + j, z + k) == static_cast<int>(Label::Empty);
    };
    return empty(-1, 0, 0) + empty(1, 0, 0) + empty(0, -1, 0) + empty(0, 1, 0) + empty(0, 0, -1) +
           empty(0, 0, 1);
  }

  std::array<BlockRows, 7> rows;  // the sides -x, +x, -y, +y, -z, +z, and the middle
  std::array<BlockLabels, 7> labels;
};

template <typename See>
void for_each_voxel(See see) {
  for (int z = 0; z < 8; ++z) {
    for (int y = 0; y < 8; ++y) {
      for (int x = 0; x < 8; ++x) see(x, y, z);
    }
  }
}

TEST(BlockBits, EqualABlockSeenVoxelByVoxel) {
  std::int64_t faces = 0;
  for (int n = 0; n < 2000; ++n) {
    SCOPED_TRACE("case " + std::to_string(n));
    RandomStream random(n, 1, 1, RandomPurpose::RangeNoise);
    const RandomBlocks blocks(random);
    const BlockLabels& middle = blocks.labels[6];
    std::array<const BlockBits*, 6> beyond;
    for (std::size_t side = 0; side < 6; ++side) beyond[side] = &blocks.labels[side].empty;
    EmptyNeighbours found;
    find_empty_neighbours(middle, beyond, found);

    int different = 0;
    int occupied_faces = 0;
    int hidden_faces = 0;
    int empty = 0;
    unsigned sides = 0;
    for_each_voxel([&](int x, int y, int z) {
      const int label = blocks.label(x, y, z);
      const auto is = [&](Label which) { return label == static_cast<int>(which); };
      const bool hidden = is(Label::Occluded) || is(Label::OcclusionPlane);
      const int touching = blocks.empty_neighbours(x, y, z);
      different += has(middle.empty, x, y, z) != is(Label::Empty);
      different += has(middle.occupied, x, y, z) != is(Label::Occupied);
      different += has(middle.occlusion_plane, x, y, z) != is(Label::OcclusionPlane);
      different += has(middle.hidden, x, y, z) != hidden;
      different += has(found.any, x, y, z) != (touching > 0);
      if (is(Label::Occupied)) occupied_faces += touching;
      if (hidden) hidden_faces += touching;
      if (!is(Label::Empty)) return;
      ++empty;
      const bool at[] = {x == 0, x == 7, y == 0, y == 7, z == 0, z == 7};
      for (unsigned side = 0; side < 6; ++side) sides |= static_cast<unsigned>(at[side]) << side;
    });
    ASSERT_EQ(different, 0);
    ASSERT_EQ(found.occupied_faces, occupied_faces);
    ASSERT_EQ(found.hidden_faces, hidden_faces);
    ASSERT_EQ(count(middle.empty), empty);
    ASSERT_EQ(sides_touched(middle.empty), sides);
    faces += occupied_faces + hidden_faces;
  }
  EXPECT_GT(faces, 100'000);
}

TEST(BlockBits, AVoxelTouchesTheSidesItLiesAt) {
  for_each_voxel([](int x, int y, int z) {
    BlockBits bits = {};
    bits[static_cast<std::size_t>(z)] = std::uint64_t{1} << (8 * x + y);
    const bool at[] = {x == 0, x == 7, y == 0, y == 7, z == 0, z == 7};
    for (unsigned side = 0; side < 6; ++side) {
      EXPECT_EQ((sides_touched(bits) >> side & 1) != 0, at[side]);
    }
  });
}

}  // namespace
}  // namespace nextview
