#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "mapper/voxel_map.h"

namespace nextview {

/// How an axis' part of a slot becomes its part of a block's number.
struct BlockAxis {
  std::uint32_t shift, mask;  ///< of the slot
  std::uint32_t begin;        ///< the window's first index; only its lowest bits matter
  std::uint32_t count;        ///< of blocks
  std::uint32_t stride;       ///< between their numbers

  static constexpr std::uint32_t kSide = 8;  ///< of a block, in voxels

  std::uint32_t part_of(std::uint32_t slot) const {
    const std::uint32_t in_window = ((slot >> shift & mask) - begin) & mask;
    return (in_window + begin % kSide) / kSide * stride;
  }
};

/// The division of a map's window into blocks of 8 x 8 x 8 voxels, aligned to absolute indices:
/// block (bx, by, bz) holds the voxels with index >> 3 = (bx, by, bz). So blocks are the same
/// wherever the window lies; those at its border stick out of it, and what sticks out reads
/// Unmarked. Blocks are numbered x fastest, then y, then z.
class MapBlocks {
 public:
  static constexpr int kSide = BlockAxis::kSide;
  static constexpr int kVoxels = kSide * kSide * kSide;
  static constexpr std::size_t kOutside = ~std::size_t{0};

  explicit MapBlocks(const VoxelMap& map);

  std::uint32_t size() const { return axes_[0].count * axes_[1].count * axes_[2].count; }
  /// Absolute coordinate of a block.
  VoxelIndex coordinate(std::uint32_t block) const;
  /// The blocks at the sides of a block, -x, +x, -y, +y, -z, +z; size() where the window has none.
  std::array<std::uint32_t, 6> neighbours(std::uint32_t block) const;

  /// The number of the block a slot of the window lies in.
  std::uint32_t block_of(std::size_t slot) const {
    const auto s = static_cast<std::uint32_t>(slot);
    return axes_[0].part_of(s) + axes_[1].part_of(s) + axes_[2].part_of(s);
  }
  /// The same for many slots, several at a time; room for as many blocks.
  void blocks_of(std::span<const std::uint32_t> slots, std::uint32_t* blocks) const;

  /// The slots of a block, by axis: entry e of an axis stands for index 8 b + e. The slot of a
  /// voxel is the sum over the axes; kOutside outside the window.
  using AxisSlots = std::array<std::size_t, kSide>;
  std::array<AxisSlots, 3> slots(std::uint32_t block) const;

 private:
  MapWindow window_;
  VoxelIndex first_;  ///< absolute coordinate of block 0
  std::array<BlockAxis, 3> axes_;
};

}  // namespace nextview
