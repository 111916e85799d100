#include "mapper/map_blocks.h"

#include "sensor/vector_clones.h"

namespace nextview {

namespace {

// Not a member: clang cannot link clones of those.
NEXTVIEW_VECTOR_CLONES
void number_blocks(const std::array<BlockAxis, 3>& of, std::span<const std::uint32_t> slots,
                   std::uint32_t* __restrict blocks) {
  const std::array<BlockAxis, 3> axes = of;
#pragma omp simd
  for (std::size_t n = 0; n < slots.size(); ++n) {
    const std::uint32_t slot = slots[n];
    blocks[n] = axes[0].part_of(slot) + axes[1].part_of(slot) + axes[2].part_of(slot);
  }
}

}  // namespace

MapBlocks::MapBlocks(const VoxelMap& map) : window_(map.window()) {
  std::uint32_t stride = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int a = static_cast<int>(axis);
    const int begin = window_.min[a];
    const int end = begin + window_.size[a];
    first_[a] = begin >> 3;
    const auto count = static_cast<std::uint32_t>(((end - 1) >> 3) - first_[a] + 1);
    axes_[axis] = {static_cast<std::uint32_t>(map.shifts()[axis]),
                   static_cast<std::uint32_t>(map.sides()[axis] - 1),
                   static_cast<std::uint32_t>(begin), count, stride};
    stride *= count;
  }
}

void MapBlocks::blocks_of(std::span<const std::uint32_t> slots, std::uint32_t* blocks) const {
  number_blocks(axes_, slots, blocks);
}

VoxelIndex MapBlocks::coordinate(std::uint32_t block) const {
  const std::uint32_t x = block % axes_[0].count;
  const std::uint32_t y = block / axes_[0].count % axes_[1].count;
  const std::uint32_t z = block / axes_[0].count / axes_[1].count;
  return first_ + VoxelIndex(static_cast<int>(x), static_cast<int>(y), static_cast<int>(z));
}

std::array<std::uint32_t, 6> MapBlocks::neighbours(std::uint32_t block) const {
  std::array<std::uint32_t, 6> numbers;
  std::uint32_t along = block;
  for (std::size_t n = 0; n < 3; ++n) {
    const BlockAxis& axis = axes_[n];
    const std::uint32_t place = along % axis.count;
    numbers[2 * n] = place > 0 ? block - axis.stride : size();
    numbers[2 * n + 1] = place + 1 < axis.count ? block + axis.stride : size();
    along /= axis.count;
  }
  return numbers;
}

std::array<MapBlocks::AxisSlots, 3> MapBlocks::slots(std::uint32_t block) const {
  std::array<AxisSlots, 3> slots;
  const VoxelIndex corner = kSide * coordinate(block);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int a = static_cast<int>(axis);
    for (std::size_t e = 0; e < slots[axis].size(); ++e) {
      const int index = corner[a] + static_cast<int>(e);
      const bool inside = index >= window_.min[a] && index < window_.min[a] + window_.size[a];
      const std::size_t part = static_cast<std::uint32_t>(index) & axes_[axis].mask;
      slots[axis][e] = inside ? part << axes_[axis].shift : kOutside;
    }
  }
  return slots;
}

}  // namespace nextview
