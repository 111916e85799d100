#include "planner/prediction/surface_table.h"

#include <utility>

namespace nextview {

void SurfaceTable::update(const VoxelMap& map, const FreeSpaceField& field,
                          std::span<const std::uint32_t> slots) {
  for (const std::uint32_t slot : slots) {
    if (map.labels()[slot] != Label::Occupied) continue;
    const VoxelIndex index = map.index_of_slot(slot);
    std::uint32_t& number = entry(field.offset(index));
    if (number == kNone) number = new_number();
    const SurfaceVoxel* surface = map.surface(index);
    if (surface == nullptr) continue;
    surfaces_[number] = {quantise_direction(surface->mean_normal()), surface->quality};
  }
}

std::uint32_t& SurfaceTable::entry(std::size_t offset) {
  if (pages_.size() <= offset / kPageSize) pages_.resize(offset / kPageSize + 1);
  std::unique_ptr<Page>& page = pages_[offset / kPageSize];
  if (page == nullptr) {
    page = std::make_unique<Page>();
    page->fill(kNone);
  }
  return (*page)[offset % kPageSize];
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

void SurfaceTable::move(const FreeSpaceField& field, const VoxelIndex& step) {
  const std::vector<std::unique_ptr<Page>> before = std::exchange(pages_, {});
  for (std::size_t page = 0; page < before.size(); ++page) {
    if (before[page] == nullptr) continue;
    for (std::size_t i = 0; i < kPageSize; ++i) {
      const std::uint32_t number = (*before[page])[i];
      if (number == kNone) continue;
      // The field reads an offset as a voxel of where it is now.
      const VoxelIndex voxel = field.index_of(page * kPageSize + i) - step;
      if (field.window().contains(voxel)) {
        entry(field.offset(voxel)) = number;
      } else {
        free_.push_back(number);
      }
    }
  }
}

void SurfaceCount::finish(const SurfaceTable& surfaces, ViewCounts& counts) {
  counts.occupied_voxels = static_cast<std::int64_t>(met_.size());
  for (const std::uint32_t surface : met_) {
    counts.normals.add(surfaces[surface].normal);
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
