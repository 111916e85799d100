#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "planner/prediction/ray_kernel.h"
#include "planner/prediction/surface_table.h"
#include "planner/prediction/view_predictor.h"

namespace nextview {

/// The same counts as PlainViewPredictor's, to the last ray, for orientations of which a few are
/// asked for at a time: count() casts the rays of those alone. The rays of an orientation are
/// tabulated when it is first asked for and then kept, 12 bytes a ray and with surfaces 18: 1700
/// orientations of 64 x 30 rays are 39 and 59 MB if ever all of them were asked for.
///
/// To ask for all at one place FastViewPredictor is sooner: it casts by direction, not by view.
class SelectiveViewPredictor : public RasterViewPredictor {
 public:
  /// @param threads how many may work at a time, at least 1
  /// @throws std::invalid_argument when there are no orientations, rays or threads, or a length is
  ///         not positive
  SelectiveViewPredictor(const PredictionRaster& raster, double voxel_size_m,
                         std::vector<Orientation> orientations, bool counts_surfaces,
                         int threads = 1);

  void predict(const KnownSpace& space, const VoxelIndex& sensor,
               std::span<ViewCounts> per_orientation) override;
  void look_from(const KnownSpace& space, const VoxelIndex& sensor) override;
  void count(std::span<const std::size_t> which, std::span<ViewCounts> counts) override;

  /// Of how many orientations the rays are in memory.
  std::size_t tabulated() const;

 private:
  // Rays of one orientation that drive in the same direction.
  struct Table {
    RayBundle bundle;
    std::vector<QuantisedDirection> directions;  // world frame, by ray; for surface counts only
  };
  using Tables = std::vector<Table>;  // those that are not empty
  // What one thread works with.
  struct Workspace {
    PacketQueue queue;
    std::vector<std::int32_t> occupied_at;  // by ray of a table; for surface counts only
    SurfaceCount surfaces;
  };

  Tables tables_of(std::size_t orientation) const;
  ViewCounts count_view(const Tables& tables, Workspace& workspace) const;

  PredictionRaster raster_;
  double reach_;
  std::vector<std::unique_ptr<Tables>> tables_;  // by orientation; null until it is asked for
  std::vector<std::size_t> all_;
  std::vector<Workspace> workspaces_;  // by thread
  const KnownSpace* space_ = nullptr;  // of the last look_from()
  VoxelIndex sensor_ = VoxelIndex::Zero();
};

}  // namespace nextview
