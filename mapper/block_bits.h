#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace nextview {

/// One bit for each voxel of a block of 8 x 8 x 8: word z, bit 8 x + y. So a step along an axis is
/// a shift of a word, or the next word.
using BlockBits = std::array<std::uint64_t, 8>;

/// The labels of a block as bytes, x fastest within a word (x = 0 lowest): the row (y, z) is
/// [8 y + z], so that the layers lie side by side in a vector.
using BlockRows = std::array<std::uint64_t, 64>;

/// A block's voxels by label.
struct BlockLabels {
  BlockBits empty;
  BlockBits occupied;
  BlockBits hidden;           ///< Occluded or OcclusionPlane
  BlockBits occlusion_plane;  ///< as labelled
};
void sort_by_label(const BlockRows& rows, BlockLabels& labels);

/// What a block's voxels of a label have to do with Empty ones at their six faces.
struct EmptyNeighbours {
  BlockBits any;  ///< voxels, of any label, at least one face of which touches an Empty voxel
  int occupied_faces = 0;  ///< faces of Occupied voxels that touch an Empty voxel
  int hidden_faces = 0;    ///< the same of hidden ones
};
/// @param beyond the Empty voxels of the blocks at the sides -x, +x, -y, +y, -z, +z
void find_empty_neighbours(const BlockLabels& labels, const std::array<const BlockBits*, 6>& beyond,
                           EmptyNeighbours& neighbours);

/// How many bits are set.
int count(const BlockBits& bits);

/// At which sides of a block, in the order above, some of its voxels lie: bit per side.
unsigned sides_touched(const BlockBits& bits);

}  // namespace nextview
