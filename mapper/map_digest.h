#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mapper/block_hash.h"
#include "mapper/lazy_array.h"
#include "mapper/map_blocks.h"
#include "mapper/voxel_map.h"

namespace nextview {

/// The digest of a voxel map, kept up to date block by block.
///
/// A block of 8 x 8 x 8 voxels hashes (XXH3, 128 bits) its absolute coordinate as three int32, its
/// 512 labels x fastest, and for each Occupied voxel in that order its normal sums as three int64,
/// normal count as uint32 and quality as uint16, all little-endian. The map hashes the canonical
/// hashes of its blocks in coordinate order (x fastest, then y, then z); blocks that are all
/// Unmarked are left out, and so is where the window lies and how large it is.
class MapDigest {
 public:
  /// Of a map that is all Unmarked; where it is not, invalidate its blocks.
  explicit MapDigest(const MapBlocks& blocks);

  /// Says that a voxel of this block may have changed.
  void invalidate(std::uint32_t block) {
    if (stale_[block]) return;
    stale_[block] = 1;
    to_hash_.push_back(block);
  }
  /// 32 hex digits. Hashes the invalidated blocks again, and then the hashes of all blocks.
  std::string digest(const VoxelMap& map, const MapBlocks& blocks);

  std::size_t memory_bytes() const;

 private:
  LazyArray<BlockHash> hashes_;      ///< by block; meaningless where absent
  LazyArray<std::uint8_t> present_;  ///< by block: not all Unmarked
  LazyArray<std::uint8_t> stale_;    ///< by block: is in to_hash_
  std::vector<std::uint32_t> to_hash_;
};

/// The digest of a map as it stands, from nothing: what MapDigest must agree with.
std::string map_digest(const VoxelMap& map);

}  // namespace nextview
