#include "mapper/map_blocks.h"

namespace nextview {

MapBlocks::MapBlocks(const VoxelMap& map) : window_(map.window()), shift_(map.shifts()) {
  std::uint32_t stride = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int a = static_cast<int>(axis);
    const int begin = window_.min[a];
    const int end = begin + window_.size[a];
    mask_[axis] = static_cast<std::size_t>(map.sides()[axis] - 1);
    first_[a] = begin >> 3;
    counts_[axis] = static_cast<std::uint32_t>(((end - 1) >> 3) - first_[a] + 1);
    number_[axis].resize(mask_[axis] + 1);
    for (int index = begin; index < end; ++index) {
      const std::uint32_t block = static_cast<std::uint32_t>((index >> 3) - first_[a]);
      number_[axis][static_cast<std::size_t>(index) & mask_[axis]] = block * stride;
    }
    stride *= counts_[axis];
  }
}

VoxelIndex MapBlocks::coordinate(std::uint32_t block) const {
  const std::uint32_t x = block % counts_[0];
  const std::uint32_t y = block / counts_[0] % counts_[1];
  const std::uint32_t z = block / counts_[0] / counts_[1];
  return first_ + VoxelIndex(static_cast<int>(x), static_cast<int>(y), static_cast<int>(z));
}

std::array<std::uint32_t, 6> MapBlocks::neighbours(std::uint32_t block) const {
  std::array<std::uint32_t, 6> numbers;
  std::uint32_t along = block;
  std::uint32_t stride = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::uint32_t place = along % counts_[axis];
    numbers[2 * axis] = place > 0 ? block - stride : size();
    numbers[2 * axis + 1] = place + 1 < counts_[axis] ? block + stride : size();
    along /= counts_[axis];
    stride *= counts_[axis];
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
      slots[axis][e] =
          inside ? (static_cast<std::size_t>(index) & mask_[axis]) << shift_[axis] : kOutside;
    }
  }
  return slots;
}

std::size_t MapBlocks::memory_bytes() const {
  std::size_t bytes = 0;
  for (const auto& axis : number_) bytes += axis.capacity() * sizeof(std::uint32_t);
  return bytes;
}

}  // namespace nextview
