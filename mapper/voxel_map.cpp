#include "mapper/voxel_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <stdexcept>

#include "lcmtypes/parameter_bounds.h"

namespace nextview {

Eigen::Vector3d SurfaceVoxel::mean_normal() const {
  const double x = static_cast<double>(normal_sum[0]);
  const double y = static_cast<double>(normal_sum[1]);
  const double z = static_cast<double>(normal_sum[2]);
  const double length = std::sqrt(x * x + y * y + z * z);
  if (length == 0.0) return Eigen::Vector3d::Zero();
  return {x / length, y / length, z / length};
}

namespace {

void check(const VoxelGrid& grid, const MapWindow& window) {
  bounds::kVoxelSize.require(grid.voxel_size_m);
  for (int axis = 0; axis < 3; ++axis) {
    bounds::kPosition.as("the map's origin, m,").require(grid.origin_m[axis]);
    bounds::kWindowMin.require(window.min[axis]);
    if (!bounds::kWindowSize.contain(window.size[axis])) {
      throw std::invalid_argument(bounds::kWindowSize.refusal(window.size[axis]) +
                                  ": choose larger voxels");
    }
  }
}

std::size_t blocks_along(int mask) { return static_cast<std::size_t>(mask / kBlockSide + 1); }

}  // namespace

VoxelMap::VoxelMap(const VoxelGrid& grid, const MapWindow& window, Label everywhere)
    : grid_(grid), window_(window) {
  check(grid, window);
  int bits = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto side = std::bit_ceil(static_cast<unsigned>(window.size[static_cast<int>(axis)]));
    mask_[axis] = static_cast<int>(side) - 1;
    shift_[axis] = bits;
    bits += std::countr_zero(side);
  }
  if (bits > 31) {
    throw std::invalid_argument(fmt::format(
        "the map's window needs 2^{} voxel slots; 2^31 are possible: choose larger voxels", bits));
  }
  labels_ = LazyArray((std::size_t{1} << bits) + kLabelPadding, everywhere);
  blocks_.resize(blocks_along(mask_[0]) * blocks_along(mask_[1]) * blocks_along(mask_[2]));
}

std::size_t VoxelMap::block_of_slot(const VoxelIndex& index) const {
  const auto x = static_cast<std::size_t>(index[0] & mask_[0]) / kBlockSide;
  const auto y = static_cast<std::size_t>(index[1] & mask_[1]) / kBlockSide;
  const auto z = static_cast<std::size_t>(index[2] & mask_[2]) / kBlockSide;
  return x + blocks_along(mask_[0]) * (y + blocks_along(mask_[1]) * z);
}

std::size_t VoxelMap::entry_in_block(const VoxelIndex& index) {
  // Sides are powers of two, so the low bits of an index and of its slot agree.
  const auto low = [](int i) { return static_cast<std::size_t>(i & (kBlockSide - 1)); };
  return low(index[0]) + kBlockSide * (low(index[1]) + kBlockSide * low(index[2]));
}

const SurfaceVoxel* VoxelMap::surface(const VoxelIndex& index) const {
  if (!contains(index)) return nullptr;
  const SurfaceBlock* block = blocks_[block_of_slot(index)].get();
  if (block == nullptr) return nullptr;
  const std::uint16_t entry = block->entry[entry_in_block(index)];
  return entry == SurfaceBlock::kNone ? nullptr : &block->voxels[entry];
}

SurfaceVoxel& VoxelMap::surface_at(const VoxelIndex& index) {
  std::unique_ptr<SurfaceBlock>& block = blocks_[block_of_slot(index)];
  if (block == nullptr) {
    block = std::make_unique<SurfaceBlock>();
    block->entry.fill(SurfaceBlock::kNone);
    block->voxels.reserve(kBlockSide);
  }
  std::uint16_t& entry = block->entry[entry_in_block(index)];
  if (entry == SurfaceBlock::kNone) {
    entry = static_cast<std::uint16_t>(block->voxels.size());
    block->voxels.emplace_back();
  }
  return block->voxels[entry];
}

void VoxelMap::forget(const VoxelIndex& index) {
  labels_[slot(index)] = Label::Unmarked;
  SurfaceBlock* block = blocks_[block_of_slot(index)].get();
  if (block == nullptr) return;
  std::uint16_t& entry = block->entry[entry_in_block(index)];
  if (entry == SurfaceBlock::kNone) return;
  // Close the gap with the last voxel, so that a long journey does not grow the block.
  const auto last = static_cast<std::uint16_t>(block->voxels.size() - 1);
  if (entry != last) {
    block->voxels[entry] = block->voxels[last];
    *std::find(block->entry.begin(), block->entry.end(), last) = entry;
  }
  block->voxels.pop_back();
  entry = SurfaceBlock::kNone;
  if (block->voxels.empty()) blocks_[block_of_slot(index)].reset();
}

void VoxelMap::move_window(const VoxelIndex& new_min) {
  for (const MapWindow& box : left_behind(window_, new_min)) {
    for_each_voxel(box, [this](const VoxelIndex& voxel) { forget(voxel); });
  }
  window_.min = new_min;
}

std::size_t VoxelMap::memory_bytes() const {
  std::size_t bytes =
      labels_.memory_bytes() + blocks_.capacity() * sizeof(std::unique_ptr<SurfaceBlock>);
  for (const auto& block : blocks_) {
    if (block) bytes += sizeof(SurfaceBlock) + block->voxels.capacity() * sizeof(SurfaceVoxel);
  }
  return bytes;
}

}  // namespace nextview
