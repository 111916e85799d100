#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mapper/map_statistics.h"
#include "mapper/voxel_map.h"
#include "sensor/range_image.h"

namespace nextview {

/// What folding one range image did to a map that lies in one buffer.
struct FoldReport : FoldCounts {
  /// Slots (VoxelMap::slot) whose label differs from before the fold, each once; in a fixed order
  /// that depends on the image and the map alone.
  std::vector<std::uint32_t> changed_slots;
  /// Slots of the voxels whose surface data differs from before the fold, each once; in a fixed
  /// order.
  std::vector<std::uint32_t> updated_surfaces;
};

/// A voxel map and everything that is kept right with every range image folded into it: labels,
/// surface data, occlusion planes, areas, digest (P8-P13). The mapper and the planner each run one
/// over the same range images. The cost of a fold grows with what the scan touches, not with the
/// map. Same images, same map, bit for bit, whatever the compiler or instruction set.
class MapBuilder {
 public:
  /// An all-Unmarked map.
  /// @throws std::invalid_argument as VoxelMap does
  MapBuilder(const VoxelGrid& grid, const MapWindow& window);
  ~MapBuilder();
  MapBuilder(MapBuilder&&) noexcept;
  MapBuilder& operator=(MapBuilder&&) noexcept;

  /// Updates the map by one range image (P12). The report stays valid until the next fold or move.
  /// @throws std::invalid_argument, the map unchanged, when the sensor lies outside the window or
  ///         the image cannot be right: sizes that disagree, fewer than 2 x 2 pixels, a ray table
  ///         or matrix that is no rotation, limits that are not 0 <= min < max, a negative range
  const FoldReport& fold(const RangeImage& image);

  /// Moves the window so that it starts at new_min, its size unchanged. What it leaves is
  /// forgotten, by labels, surface data, statistics and digest alike; what it enters is Unmarked,
  /// also where it has been before. The cost grows with what is left behind, not with the map.
  /// @return slots whose voxel lies inside both before and after and has another label: planes that
  ///         only touched Empty voxels that are forgotten. Valid until the next fold or move.
  std::span<const std::uint32_t> move_window(const VoxelIndex& new_min);

  const VoxelMap& map() const;
  MapStatistics statistics() const;

  /// The digest of the whole map, 32 hex digits; see map_digest.h. Only what changed since the last
  /// call is hashed again.
  std::string digest();

  /// Bytes of heap memory in use, the map's own included.
  std::size_t memory_bytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nextview
