#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mapper/map_builder.h"
#include "scoring/near_surface.h"

namespace nextview {

/// How much of what has been recovered is there: the share of Occupied voxels with surface of the
/// CAD model in or beside them (see NearSurface). 1 is best; 1 minus this is the share of Occupied
/// voxels that noise has put where nothing is. Where the surface is may become known later than the
/// first views.
class SurfacePrecision {
 public:
  /// Notes what a view added to the map; to be called once after every fold.
  void add_view(const VoxelMap& map, const FoldReport& fold);

  /// Says where the surface is; for the map's window.
  void set_near(const VoxelMap& map, NearSurface near);

  /// The precision after a view, in [0, 1]; nothing while it is not known where the surface is, or
  /// when nothing is Occupied.
  std::optional<double> after_view(int view) const;

 private:
  struct Count {
    std::int64_t occupied = 0;
    std::int64_t near = 0;
  };
  void count(const VoxelMap& map, const std::vector<std::uint32_t>& slots);

  std::vector<std::vector<std::uint32_t>> waiting_;  ///< slots by view, until the surface is known
  std::optional<NearSurface> near_;
  std::vector<Count> counts_;  ///< by view - 1
};

}  // namespace nextview
