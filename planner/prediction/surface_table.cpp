#include "planner/prediction/surface_table.h"

namespace nextview {

void SurfaceTable::update(const VoxelMap& map, const FreeSpaceField& field,
                          std::span<const std::uint32_t> slots) {
  for (const std::uint32_t slot : slots) {
    if (map.labels()[slot] != Label::Occupied) continue;
    const VoxelIndex index = map.index_of_slot(slot);
    const std::size_t offset = field.offset(index);
    if (pages_.size() <= offset / kPageSize) pages_.resize(offset / kPageSize + 1);
    std::unique_ptr<Page>& page = pages_[offset / kPageSize];
    if (page == nullptr) {
      page = std::make_unique<Page>();
      page->fill(kNone);
    }
    std::uint32_t& number = (*page)[offset % kPageSize];
    if (number == kNone) {
      number = static_cast<std::uint32_t>(surfaces_.size());
      surfaces_.emplace_back();
    }
    const SurfaceVoxel* surface = map.surface(index);
    if (surface == nullptr) continue;
    surfaces_[number] = {quantise_direction(surface->mean_normal()), surface->quality};
  }
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
