#include "mapper/block_counts.h"

namespace nextview {

BlockCounts counts_of(const BlockLabels& labels, const EmptyNeighbours& open) {
  BlockCounts counts;
  const auto set = [&](Label label, int voxels) {
    counts.voxels[static_cast<std::size_t>(label)] = static_cast<std::uint16_t>(voxels);
  };
  const int planes = count(labels.occlusion_plane);
  set(Label::OcclusionPlane, planes);
  set(Label::Occluded, count(labels.hidden) - planes);
  set(Label::Empty, count(labels.empty));
  set(Label::Occupied, count(labels.occupied));
  counts.occupied_faces = static_cast<std::uint16_t>(open.occupied_faces);
  counts.occlusion_plane_faces = static_cast<std::uint16_t>(open.hidden_faces);
  return counts;
}

MapCounts::MapCounts(const MapWindow& window) {
  voxels_[static_cast<std::size_t>(Label::Unmarked)] =
      std::int64_t{window.size[0]} * window.size[1] * window.size[2];
}

void MapCounts::add(const BlockCounts& counts, int sign) {
  for (std::size_t label = 1; label < kLabelCount; ++label) {
    voxels_[label] += sign * counts.voxels[label];
    voxels_[static_cast<std::size_t>(Label::Unmarked)] -= sign * counts.voxels[label];
  }
  occupied_faces_ += sign * counts.occupied_faces;
  occlusion_plane_faces_ += sign * counts.occlusion_plane_faces;
}

}  // namespace nextview
