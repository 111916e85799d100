#pragma once

#include <array>
#include <cstdint>

#include "mapper/block_bits.h"
#include "mapper/voxel_map.h"

namespace nextview {

/// What a block of voxels adds to a map's counts.
struct BlockCounts {
  std::array<std::uint16_t, kLabelCount> voxels = {};  ///< by Label; Unmarked ones are not counted
  std::uint16_t occupied_faces = 0;         ///< faces of Occupied voxels that touch an Empty voxel
  std::uint16_t occlusion_plane_faces = 0;  ///< the same of OcclusionPlane voxels
};
/// @param labels its occlusion planes being what `open` says
BlockCounts counts_of(const BlockLabels& labels, const EmptyNeighbours& open);

/// The counts of a map, block by block.
class MapCounts {
 public:
  /// All Unmarked.
  explicit MapCounts(const MapWindow& window);

  void add(const BlockCounts& counts) { add(counts, 1); }
  void take_away(const BlockCounts& counts) { add(counts, -1); }

  /// They sum to the window's volume.
  std::int64_t voxels(Label label) const { return voxels_[static_cast<std::size_t>(label)]; }
  /// Faces of Occupied voxels that touch an Empty voxel of the window.
  std::int64_t occupied_faces() const { return occupied_faces_; }
  /// Faces of OcclusionPlane voxels that touch an Empty voxel of the window.
  std::int64_t occlusion_plane_faces() const { return occlusion_plane_faces_; }

 private:
  void add(const BlockCounts& counts, int sign);

  std::array<std::int64_t, kLabelCount> voxels_ = {};
  std::int64_t occupied_faces_ = 0;
  std::int64_t occlusion_plane_faces_ = 0;
};

}  // namespace nextview
