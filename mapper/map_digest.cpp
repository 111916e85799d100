#include "mapper/map_digest.h"

#include <algorithm>

namespace nextview {

namespace {

// Unmarked where the block sticks out of the window.
LabelBytes labels_of(const VoxelMap& map, const MapBlocks& blocks, std::uint32_t block) {
  constexpr std::size_t kSide = kBlockSide;
  LabelBytes bytes = {};
  const auto [xs, ys, zs] = blocks.slots(block);
  for (std::size_t row = 0; row < kSide * kSide; ++row) {
    const std::size_t y = ys[row % kSide];
    const std::size_t z = zs[row / kSide];
    if (y == MapBlocks::kOutside || z == MapBlocks::kOutside) continue;
    const Label* const from = map.labels().data() + y + z;
    for (std::size_t x = 0; x < kSide; ++x) {
      const std::size_t slot = xs[x];
      if (slot != MapBlocks::kOutside) {
        bytes[row * kSide + x] = static_cast<std::uint8_t>(from[slot]);
      }
    }
  }
  return bytes;
}

}  // namespace

MapDigest::MapDigest(const MapBlocks& blocks)
    : hashes_(blocks.size()), present_(blocks.size()), stale_(blocks.size()) {}

std::string MapDigest::digest(const VoxelMap& map, const MapBlocks& blocks) {
  // Blocks next to each other along x share cache lines.
  std::sort(to_hash_.begin(), to_hash_.end());
  for (const std::uint32_t block : to_hash_) {
    stale_[block] = 0;
    const LabelBytes labels = labels_of(map, blocks, block);
    present_[block] = labels != kAllUnmarked ? 1 : 0;
    if (!present_[block]) continue;
    const VoxelIndex coordinate = blocks.coordinate(block);
    hashes_[block] = block_hash(coordinate, labels, [&](std::size_t entry) {
      const auto v = static_cast<int>(entry);
      const VoxelIndex offset(v % kBlockSide, v / kBlockSide % kBlockSide,
                              v / (kBlockSide * kBlockSide));
      return map.surface(kBlockSide * coordinate + offset);
    });
  }
  to_hash_.clear();

  HashOfBlocks whole;
  blocks.for_each_in_order([&](std::uint32_t block) {
    if (present_[block]) whole.add(hashes_[block]);
  });
  return whole.hex_digits();
}

std::size_t MapDigest::memory_bytes() const {
  return hashes_.memory_bytes() + present_.memory_bytes() + stale_.memory_bytes() +
         to_hash_.capacity() * sizeof(to_hash_[0]);
}

std::string map_digest(const VoxelMap& map) {
  const MapBlocks blocks(map);
  MapDigest digest(blocks);
  for (std::uint32_t block = 0; block < blocks.size(); ++block) digest.invalidate(block);
  return digest.digest(map, blocks);
}

}  // namespace nextview
