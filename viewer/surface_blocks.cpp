#include "viewer/surface_blocks.h"

#include <algorithm>
#include <cmath>

namespace nextview {
namespace {

std::int8_t in_127ths(double component) {
  return static_cast<std::int8_t>(std::lround(127.0 * component));
}

void append_surface(const SurfaceVoxel* surface, std::vector<std::uint8_t>& bytes) {
  const Eigen::Vector3d normal =
      surface == nullptr ? Eigen::Vector3d::Zero() : surface->mean_normal();
  for (int axis = 0; axis < 3; ++axis) append_number(bytes, in_127ths(normal[axis]));
  const double quality = surface == nullptr ? 0.0 : surface->quality_01();
  append_number(bytes, static_cast<std::uint8_t>(std::lround(255.0 * quality)));
}

}  // namespace

std::vector<std::uint8_t> surface_of_block(const VoxelMap& map, const MapBlocks& blocks,
                                           std::uint32_t block) {
  std::vector<std::uint8_t> bytes;
  const std::array<MapBlocks::AxisSlots, 3> slots = blocks.slots(block);
  const std::span<const Label> labels = map.labels();
  std::uint32_t place = 0;
  for (const std::size_t z : slots[2]) {
    for (const std::size_t y : slots[1]) {
      for (const std::size_t x : slots[0]) {
        const std::uint32_t here = place++;
        if (x == MapBlocks::kOutside || y == MapBlocks::kOutside || z == MapBlocks::kOutside) {
          continue;
        }
        const std::size_t slot = x + y + z;
        if (labels[slot] == Label::Occupied) {
          append_number(bytes, here);
          append_surface(map.surface(map.index_of_slot(slot)), bytes);
        } else if (labels[slot] == Label::OcclusionPlane) {
          append_number(bytes, here | kOcclusionPlaneBit);
          append_surface(nullptr, bytes);
        }
      }
    }
  }
  return bytes;
}

std::vector<std::uint32_t> changed_blocks(const MapBlocks& blocks, const FoldReport& report) {
  std::vector<std::uint32_t> changed;
  std::vector<std::uint32_t> numbers;
  for (const auto* slots : {&report.changed_slots, &report.updated_surfaces}) {
    numbers.resize(slots->size());
    blocks.blocks_of(*slots, numbers.data());
    changed.insert(changed.end(), numbers.begin(), numbers.end());
  }
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  return changed;
}

}  // namespace nextview
