#include "scoring/surface_coverage.h"

#include "scoring/newly_occupied.h"

namespace nextview {

void SurfaceCoverage::add_view(const VoxelMap& map, const FoldReport& fold) {
  newly_occupied_.push_back(newly_occupied(map, fold));
  if (samples_ > 0) count(newly_occupied_.size() - 1);
}

void SurfaceCoverage::set_visible(const VoxelMap& map, const VisibleSurface& surface) {
  samples_ = static_cast<std::int64_t>(surface.points_m.size());
  for (const Eigen::Vector3f& point_m : surface.points_m) {
    const VoxelIndex voxel = map.grid().voxel_of(point_m.cast<double>());
    if (map.contains(voxel)) ++samples_in_slot_[static_cast<std::uint32_t>(map.slot(voxel))];
  }
  for (std::size_t i = 0; i < newly_occupied_.size(); ++i) count(i);
}

void SurfaceCoverage::count(std::size_t view_index) {
  std::int64_t recovered = recovered_.empty() ? 0 : recovered_.back();
  for (const std::uint32_t slot : newly_occupied_[view_index]) {
    const auto samples = samples_in_slot_.find(slot);
    if (samples != samples_in_slot_.end()) recovered += samples->second;
  }
  recovered_.push_back(recovered);
}

std::optional<double> SurfaceCoverage::after_view(int view) const {
  const auto index = static_cast<std::size_t>(view - 1);
  if (view < 1 || index >= recovered_.size()) return std::nullopt;
  return static_cast<double>(recovered_[index]) / static_cast<double>(samples_);
}

}  // namespace nextview
