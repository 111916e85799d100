#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mapper/voxel_map.h"

namespace nextview {

/// The division of a map's window into blocks of 8 x 8 x 8 voxels, aligned to absolute indices:
/// block (bx, by, bz) holds the voxels with index >> 3 = (bx, by, bz). So blocks are the same
/// wherever the window lies; those at its border stick out of it, and what sticks out reads
/// Unmarked. Blocks are numbered x fastest, then y, then z.
class MapBlocks {
 public:
  static constexpr int kSide = 8;
  static constexpr int kVoxels = kSide * kSide * kSide;
  static constexpr std::size_t kOutside = ~std::size_t{0};

  explicit MapBlocks(const VoxelMap& map);

  std::uint32_t size() const { return counts_[0] * counts_[1] * counts_[2]; }
  /// Absolute coordinate of a block.
  VoxelIndex coordinate(std::uint32_t block) const;
  /// The blocks at the sides of a block, -x, +x, -y, +y, -z, +z; size() where the window has none.
  std::array<std::uint32_t, 6> neighbours(std::uint32_t block) const;

  /// The number of the block a slot of the window lies in.
  std::uint32_t block_of(std::size_t slot) const {
    return number_[0][slot & mask_[0]] + number_[1][slot >> shift_[1] & mask_[1]] +
           number_[2][slot >> shift_[2]];
  }

  /// The slots of a block, by axis: entry e of an axis stands for index 8 b + e. The slot of a
  /// voxel is the sum over the axes; kOutside outside the window.
  using AxisSlots = std::array<std::size_t, kSide>;
  std::array<AxisSlots, 3> slots(std::uint32_t block) const;

  std::size_t memory_bytes() const;

 private:
  MapWindow window_;
  std::array<std::size_t, 3> mask_;
  std::array<int, 3> shift_;
  VoxelIndex first_;  ///< absolute coordinate of block 0
  std::array<std::uint32_t, 3> counts_;
  std::array<std::vector<std::uint32_t>, 3> number_;  ///< per axis, by the slot's part of that axis
};

}  // namespace nextview
