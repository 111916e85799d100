#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mapper/block_bits.h"
#include "mapper/block_counts.h"
#include "mapper/lazy_array.h"
#include "mapper/map_blocks.h"
#include "mapper/voxel_map.h"

namespace nextview {

/// The voxels of a map counted block by block, and its occlusion planes (P8, P13).
///
/// A label, and whether an Occluded voxel is an OcclusionPlane, depends on the voxel and its six
/// neighbours only. So after a range image the blocks it changed, and those at a side of which a
/// voxel became Empty or ceased to be, are looked at again as a whole, and the totals take the
/// difference. Blocks are looked at in bits: 64 voxels at a time.
class MapCensus {
 public:
  /// Of a map that is all Unmarked.
  MapCensus(const VoxelMap& map, const MapBlocks& blocks);

  /// Takes note that these slots' labels have changed.
  void note_changes(const MapBlocks& blocks, std::span<const std::uint32_t> slots);

  /// Takes note that some voxels of these blocks are about to be forgotten: that the window is
  /// about to leave them. To be told before the map and the blocks move.
  void note_leaving(const MapBlocks& blocks, std::uint32_t block);

  /// Derives the occlusion planes around what has changed and counts again. Voxels that turned from
  /// Occluded to OcclusionPlane or back without having been noted are added to changed_slots.
  /// @return the blocks looked at, which are the only ones whose labels may have changed since the
  ///         last call; valid until the next one
  std::span<const std::uint32_t> update(VoxelMap& map, const MapBlocks& blocks,
                                        std::vector<std::uint32_t>& changed_slots);

  const MapCounts& totals() const { return totals_; }

  std::size_t memory_bytes() const;

 private:
  struct LookedAt {
    std::uint32_t block;
    BlockLabels labels;
  };

  void list(std::uint32_t block) {
    if (listed_[block]) return;
    listed_[block] = 1;
    to_look_.push_back(block);
  }
  void take_labels(const VoxelMap& map, const MapBlocks& blocks, std::uint32_t block);
  void list_neighbours(const MapBlocks& blocks, std::uint32_t block, unsigned sides);
  BlockCounts derive(VoxelMap& map, const MapBlocks& blocks, LookedAt& at,
                     std::vector<std::uint32_t>& changed_slots) const;

  LazyArray<BlockCounts> counts_;   ///< by block
  LazyArray<BlockBits> empty_;      ///< by block
  LazyArray<BlockBits> hidden_;     ///< by block; a label of these changes here alone
  LazyArray<std::uint8_t> listed_;  ///< by block: whether in to_look_
  std::vector<std::uint32_t> to_look_;
  std::vector<std::uint32_t> looked_;
  std::vector<LookedAt> labels_;  ///< of the blocks in to_look_
  MapCounts totals_;
};

}  // namespace nextview
