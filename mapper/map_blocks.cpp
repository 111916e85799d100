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
    // A window of this size touches the most blocks when it begins with the last voxel of one.
    const int last = kBlockSide - 1 + window_.size[static_cast<int>(axis)] - 1;
    const auto count = static_cast<std::uint32_t>(block_of_index(last) + 1);
    axes_[axis] = {static_cast<std::uint32_t>(map.shifts()[axis]),
                   static_cast<std::uint32_t>(map.sides()[axis] - 1),
                   0,
                   count,
                   stride,
                   0};
    stride *= count;
  }
  move_window(window_.min);
}

void MapBlocks::move_window(const VoxelIndex& new_min) {
  window_.min = new_min;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int a = static_cast<int>(axis);
    first_[a] = block_of_index(new_min[a]);
    const auto count = static_cast<int>(axes_[axis].count);
    axes_[axis].begin = static_cast<std::uint32_t>(new_min[a]);
    axes_[axis].first_place = static_cast<std::uint32_t>((first_[a] % count + count) % count);
  }
}

void MapBlocks::blocks_of(std::span<const std::uint32_t> slots, std::uint32_t* blocks) const {
  number_blocks(axes_, slots, blocks);
}

VoxelIndex MapBlocks::coordinate(std::uint32_t block) const {
  const std::uint32_t x = axes_[0].nth_at(block % axes_[0].count);
  const std::uint32_t y = axes_[1].nth_at(block / axes_[0].count % axes_[1].count);
  const std::uint32_t z = axes_[2].nth_at(block / axes_[0].count / axes_[1].count);
  return first_ + VoxelIndex(static_cast<int>(x), static_cast<int>(y), static_cast<int>(z));
}

std::array<std::uint32_t, 6> MapBlocks::neighbours(std::uint32_t block) const {
  std::array<std::uint32_t, 6> numbers;
  std::uint32_t along = block;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const BlockAxis& a = axes_[axis];
    const std::uint32_t place = along % a.count;
    const std::uint32_t n = a.nth_at(place);
    const auto with_nth = [&](std::uint32_t other) {
      return block + (a.place_of(other) - place) * a.stride;
    };
    numbers[2 * axis] = n > 0 ? with_nth(n - 1) : size();
    numbers[2 * axis + 1] = n + 1 < a.count ? with_nth(n + 1) : size();
    along /= a.count;
  }
  return numbers;
}

std::array<MapBlocks::AxisSlots, 3> MapBlocks::slots(std::uint32_t block) const {
  std::array<AxisSlots, 3> slots;
  const VoxelIndex corner = kBlockSide * coordinate(block);
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
