#pragma once

#include <algorithm>
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
  std::uint32_t first_place;  ///< of the window's first block, below count

  std::uint32_t part_of(std::uint32_t slot) const {
    const std::uint32_t in_window = ((slot >> shift & mask) - begin) & mask;
    return place_of((in_window + begin % kBlockSide) / kBlockSide) * stride;
  }
  /// The place of the window's n-th block, n < count.
  std::uint32_t place_of(std::uint32_t n) const {
    const std::uint32_t place = first_place + n;
    return std::min(place, place - count);  // the latter wraps to a huge number below count
  }
  /// Which of the window's blocks has a place.
  std::uint32_t nth_at(std::uint32_t place) const {
    return place < first_place ? place + count - first_place : place - first_place;
  }
};

/// The blocks (kBlockSide) of a map's window, numbered by a circular buffer as its slots are: along
/// each axis a block's place is its absolute coordinate modulo as many blocks as the window can
/// touch, wherever it lies, and the number is made of the three places, x fastest. So what is kept
/// by block stays where it is when the window moves, and a block that enters takes the number of
/// one that has left.
///
/// Blocks at the window's border stick out of it, and what sticks out reads Unmarked; some numbers
/// may stand for blocks that lie outside as a whole. The buffer is not the slots' own divided by
/// kBlockSide: there the two ends of a window that is not aligned would share a block. Nor is it a
/// power of two, which for a window of one would double every side.
class MapBlocks {
 public:
  static constexpr std::size_t kOutside = ~std::size_t{0};

  explicit MapBlocks(const VoxelMap& map);

  /// Follows the map's window.
  void move_window(const VoxelIndex& new_min);

  std::uint32_t size() const { return axes_[0].count * axes_[1].count * axes_[2].count; }
  /// Absolute coordinate of a block.
  VoxelIndex coordinate(std::uint32_t block) const;
  /// Calls see(number) for all blocks in the order of their coordinates, x fastest.
  template <typename See>
  void for_each_in_order(See see) const {
    for_each_of({VoxelIndex::Zero(), counts()}, see);
  }
  /// Calls see(number) for the blocks that meet a box of voxels inside the window.
  template <typename See>
  void for_each_in(const MapWindow& box, See see) const {
    if (box.is_empty()) return;
    const auto block_of_voxel = [](const VoxelIndex& v) { return v.unaryExpr(&block_of_index); };
    const VoxelIndex min = block_of_voxel(box.min);
    const VoxelIndex max = block_of_voxel(box.min + box.size - VoxelIndex::Ones());
    for_each_of({min - first_, max - min + VoxelIndex::Ones()}, see);
  }
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
  using AxisSlots = std::array<std::size_t, kBlockSide>;
  std::array<AxisSlots, 3> slots(std::uint32_t block) const;

 private:
  VoxelIndex counts() const {
    return {static_cast<int>(axes_[0].count), static_cast<int>(axes_[1].count),
            static_cast<int>(axes_[2].count)};
  }
  // Of the window's n-th blocks along each axis.
  template <typename See>
  void for_each_of(const MapWindow& nths, See see) const {
    const auto part = [this](std::size_t axis, int n) {
      return axes_[axis].place_of(static_cast<std::uint32_t>(n)) * axes_[axis].stride;
    };
    const VoxelIndex end = nths.min + nths.size;
    for (int z = nths.min[2]; z < end[2]; ++z) {
      for (int y = nths.min[1]; y < end[1]; ++y) {
        const std::uint32_t row = part(1, y) + part(2, z);
        for (int x = nths.min[0]; x < end[0]; ++x) see(row + part(0, x));
      }
    }
  }

  MapWindow window_;
  VoxelIndex first_;  ///< absolute coordinate of the window's first block
  std::array<BlockAxis, 3> axes_;
};

}  // namespace nextview
