#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "mapper/map_blocks.h"
#include "mapper/map_builder.h"

namespace nextview {

/// Appends a number, least significant byte first, as everything is that the page reads.
template <class Number>
void append_number(std::vector<std::uint8_t>& bytes, Number value) {
  static_assert(std::is_trivially_copyable_v<Number>);
  static_assert(std::endian::native == std::endian::little);
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof value);
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

/// What of a voxel map is drawn: its surface voxels, which are those Occupied and the occlusion
/// planes, 8 bytes each:
///   u32  bits 0..8 the place in the block, x + 8 y + 64 z; bit 9 whether it is an OcclusionPlane
///   i8   x, y, z of the mean normal in 1/127, world frame, towards the sensor; zero: there is none
///   u8   quality in 1/255
constexpr std::size_t kSurfaceVoxelBytes = 8;
constexpr std::uint32_t kOcclusionPlaneBit = 1U << 9;

/// The surface voxels of a block, as above; their order is that of their places.
std::vector<std::uint8_t> surface_of_block(const VoxelMap& map, const MapBlocks& blocks,
                                           std::uint32_t block);

/// The numbers of the blocks that a fold has changed, each once, in increasing order.
std::vector<std::uint32_t> changed_blocks(const MapBlocks& blocks, const FoldReport& report);

}  // namespace nextview
