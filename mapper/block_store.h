#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "mapper/block_bits.h"
#include "mapper/block_content.h"
#include "mapper/block_counts.h"
#include "mapper/block_hash.h"
#include "mapper/key_numbers.h"
#include "mapper/packed_block.h"
#include "mapper/voxel_map.h"

namespace nextview {

/// The bit of a voxel in BlockBits.
struct VoxelBit {
  std::size_t word;
  std::uint64_t bit;

  explicit VoxelBit(const VoxelIndex& voxel)
      : word(static_cast<std::size_t>(voxel[2] & (kBlockSide - 1))),
        bit(std::uint64_t{1} << (kBlockSide * (voxel[0] & (kBlockSide - 1)) +
                                 (voxel[1] & (kBlockSide - 1)))) {}
  bool is_in(const BlockBits& bits) const { return (bits[word] & bit) != 0; }
  /// How many voxels of a set come before this one.
  std::size_t rank_in(const BlockBits& bits) const;
};

/// A block of a map, ready to be worked on.
struct OpenBlock {
  VoxelIndex coordinate = VoxelIndex::Zero();
  BlockLabels labels{};
  /// Of the Occupied voxels, in the order of their bits.
  std::vector<SurfaceVoxel> surfaces;
  BlockCounts counts;         ///< as last counted
  BlockBits counted_empty{};  ///< what was Empty then
  BlockHash hash{};           ///< of the content, unless stale
  int changed_in = 0;         ///< for whoever counts the changes: the last; 0: never
  bool is_marked = false;     ///< not all Unmarked
  bool is_stale = false;      ///< changed since it was hashed
  bool is_noted = false;      ///< for whoever works on it
};

Label label_in(const OpenBlock& block, const VoxelIndex& voxel);

/// The blocks of a map that is larger than what lies open in memory: those of a window stand in a
/// circular buffer, all others that have been seen are kept aside, packed, in the order of their
/// coordinates. When the window moves, the blocks it leaves are packed and those it enters come
/// back as they were; nothing that stays is moved in memory (P10). A block elsewhere can be opened
/// too, until close_far().
class BlockStore {
 public:
  /// @param extent      what the map covers
  /// @param window_size voxels; the window is as many blocks as that, rounded up, and no larger
  /// than
  ///                    the extent's
  BlockStore(const MapWindow& extent, const VoxelIndex& window_size);

  /// The blocks that stand open, in voxels.
  MapWindow window() const;
  /// Moves the window, inside the extent, so that a voxel lies in its middle half along each axis.
  void follow(const VoxelIndex& voxel);

  /// The block of a coordinate of the extent; from outside the window it is opened, and the
  /// reference holds until close_far().
  OpenBlock& open(const VoxelIndex& coordinate);
  /// The same of any coordinate; nullptr where there is nothing but Unmarked voxels.
  OpenBlock* open_marked(const VoxelIndex& coordinate);
  /// Packs what has been opened outside the window and is stale.
  void close_far();

  /// The label, and the surface data if there is any, of a voxel wherever it lies. A block kept
  /// aside is unpacked for this.
  Label label(const VoxelIndex& voxel) const;
  const SurfaceVoxel* surface(const VoxelIndex& voxel) const;

  /// All there is in a block, wherever it lies.
  BlockContent content(const VoxelIndex& coordinate) const;

  /// Coordinates of the blocks whose changed_in is larger than this, in their order, x fastest.
  /// Nothing may be open elsewhere.
  std::vector<VoxelIndex> changed_after(int changed_in) const;

  /// The hashes of all blocks that are not all Unmarked, those of the window and those aside, in
  /// the order of their coordinates, x fastest. Nothing may be open elsewhere.
  void hash(HashOfBlocks& whole);

  std::size_t blocks_aside() const { return aside_.size(); }
  std::size_t memory_bytes() const;

 private:
  struct AsideBlock {
    PackedBlock labels;
    std::vector<SurfaceVoxel> surfaces;
    BlockCounts counts;
    BlockHash hash;
    int changed_in;
  };
  using Key = std::array<int, 3>;  // z, y, x
  static Key key(const VoxelIndex& coordinate) {
    return {coordinate[2], coordinate[1], coordinate[0]};
  }

  // Calls of_open(block) or of_aside(key, block) for all blocks that are not all Unmarked, in the
  // order of their coordinates.
  template <class OfOpen, class OfAside>
  void for_each_marked(OfOpen of_open, OfAside of_aside) const;
  std::size_t place(const VoxelIndex& coordinate) const;
  void leave(OpenBlock& block);
  void enter(const VoxelIndex& coordinate);
  static AsideBlock packed(OpenBlock& block);
  static void unpack(const AsideBlock& aside, OpenBlock& block);

  MapWindow extent_;  // in blocks, as is the next
  MapWindow open_;
  std::vector<OpenBlock> window_;
  std::deque<OpenBlock> far_;  // opened outside the window
  KeyNumbers far_numbers_;     // of them
  std::map<Key, AsideBlock> aside_;
};

}  // namespace nextview
