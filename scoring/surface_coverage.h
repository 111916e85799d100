#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "mapper/map_builder.h"
#include "scoring/visible_surface.h"

namespace nextview {

/// How much of the surface that could be seen has been recovered: the share of its samples whose
/// voxel is Occupied. What could be seen may become known later than the first views.
class SurfaceCoverage {
 public:
  /// Notes what a view added to the map; to be called once after every fold.
  void add_view(const VoxelMap& map, const FoldReport& fold);

  /// Says what could be seen. Samples outside the map's window count as never recovered.
  void set_visible(const VoxelMap& map, const VisibleSurface& surface);

  /// The coverage after a view, in [0, 1]; nothing while it is not known what could be seen, or
  /// when nothing could be.
  std::optional<double> after_view(int view) const;

 private:
  void count(std::size_t view_index);

  std::vector<std::vector<std::uint32_t>> newly_occupied_;           ///< slots, by view - 1
  std::unordered_map<std::uint32_t, std::int64_t> samples_in_slot_;  ///< looked up only
  std::vector<std::int64_t> recovered_;                              ///< samples, by view - 1
  std::int64_t samples_ = 0;
};

}  // namespace nextview
