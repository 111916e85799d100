#pragma once

#include <tbb/task_arena.h>

#include <optional>
#include <vector>

#include "planner/free_space_field.h"
#include "planner/ray_kernel.h"
#include "planner/surface_table.h"
#include "planner/view_predictor.h"

namespace nextview {

/// The same counts as PlainViewPredictor's, to the last ray, some forty times sooner: the rays of
/// every orientation are tabulated once (their lines do not depend on where the sensor is), and
/// walk through a FreeSpaceField many at a time (ray_kernel.h). Orientations are shared out among
/// the threads; every one writes its own counts, so the result does not depend on how.
class FastViewPredictor : public RasterViewPredictor {
 public:
  /// @param threads how many may work at a time, at least 1
  /// @throws std::invalid_argument when there are no orientations, rays or threads, or a length is
  ///         not positive
  FastViewPredictor(const PredictionRaster& raster, double voxel_size_m,
                    std::vector<Orientation> orientations, bool counts_quality, int threads = 1);

  void predict(const VoxelMap& map, const VoxelIndex& sensor,
               std::span<ViewCounts> per_orientation) override;
  void map_changed(const VoxelMap& map, std::span<const std::uint32_t> changed_slots,
                   std::span<const std::uint32_t> updated_surfaces) override;

 private:
  // The rays of one orientation, by the direction they drive in.
  struct View {
    std::vector<RayBundle> bundles;
    std::vector<QuantisedDirection> directions;  // world frame, by RayBundle::ray
  };
  // What one thread works with.
  struct Workspace {
    std::vector<std::int32_t> met;
    ImprovementCount improvement;
  };

  View make_view(const RayTable& rays, const Orientation& orientation, double reach) const;
  void prepare(const VoxelMap& map);
  ViewCounts predict_view(const View& view, std::int32_t start, std::int32_t first_k,
                          Workspace& workspace) const;

  std::vector<View> views_;
  std::optional<FreeSpaceField> field_;  // of the map of the last call
  SurfaceTable surfaces_;
  tbb::task_arena arena_;
  std::vector<Workspace> workspaces_;  // by thread of the arena
};

}  // namespace nextview
