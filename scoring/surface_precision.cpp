#include "scoring/surface_precision.h"

#include <utility>

#include "scoring/newly_occupied.h"

namespace nextview {

void SurfacePrecision::add_view(const VoxelMap& map, const FoldReport& fold) {
  std::vector<std::uint32_t> slots = newly_occupied(map, fold);
  if (near_) {
    count(map, slots);
  } else {
    waiting_.push_back(std::move(slots));
  }
}

void SurfacePrecision::set_near(const VoxelMap& map, NearSurface near) {
  near_ = std::move(near);
  for (const std::vector<std::uint32_t>& slots : waiting_) count(map, slots);
  waiting_.clear();
}

void SurfacePrecision::count(const VoxelMap& map, const std::vector<std::uint32_t>& slots) {
  Count sum = counts_.empty() ? Count{} : counts_.back();
  for (const std::uint32_t slot : slots) {
    ++sum.occupied;
    if (near_->holds(map.index_of_slot(slot))) ++sum.near;
  }
  counts_.push_back(sum);
}

std::optional<double> SurfacePrecision::after_view(int view) const {
  const auto index = static_cast<std::size_t>(view - 1);
  if (view < 1 || index >= counts_.size() || counts_[index].occupied == 0) return std::nullopt;
  return static_cast<double>(counts_[index].near) / static_cast<double>(counts_[index].occupied);
}

}  // namespace nextview
