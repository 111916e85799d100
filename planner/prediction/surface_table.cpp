#include "planner/prediction/surface_table.h"

namespace nextview {

void SurfaceTable::update(const VoxelMap& map, std::span<const std::uint32_t> slots) {
  for (const std::uint32_t slot : slots) {
    if (map.labels()[slot] != Label::Occupied) continue;
    if (pages_.size() <= slot / kPageSize) pages_.resize(slot / kPageSize + 1);
    std::unique_ptr<Page>& page = pages_[slot / kPageSize];
    if (page == nullptr) {
      page = std::make_unique<Page>();
      page->fill(kNone);
    }
    std::uint32_t& number = (*page)[slot % kPageSize];
    if (number == kNone) number = new_number();
    const SurfaceVoxel* surface = map.surface(map.index_of_slot(slot));
    if (surface == nullptr) continue;
    surfaces_[number] = {quantise_direction(surface->mean_normal()), surface->quality};
  }
}

std::uint32_t SurfaceTable::new_number() {
  if (free_.empty()) {
    surfaces_.emplace_back();
    return static_cast<std::uint32_t>(surfaces_.size() - 1);
  }
  const std::uint32_t number = free_.back();
  free_.pop_back();
  surfaces_[number] = Surface();
  return number;
}

void SurfaceTable::forget(const VoxelMap& map, const MapWindow& left) {
  for_each_voxel(left, [&](const VoxelIndex& voxel) {
    const std::size_t slot = map.slot(voxel);
    if (slot / kPageSize >= pages_.size() || pages_[slot / kPageSize] == nullptr) return;
    std::uint32_t& number = (*pages_[slot / kPageSize])[slot % kPageSize];
    if (number == kNone) return;
    free_.push_back(number);
    number = kNone;
  });
}

void ImprovementCount::finish(const SurfaceTable& surfaces, ViewCounts& counts) {
  counts.occupied_voxels = static_cast<std::int64_t>(met_.size());
  for (const std::uint32_t surface : met_) {
    const int gain = predicted_quality(best_[surface]) - surfaces[surface].quality;
    if (gain > 0) {
      ++counts.improved_voxels;
      counts.improvement += gain;
    }
  }
  met_.clear();
  ++view_;
}

}  // namespace nextview
