#pragma once

#include <array>
#include <vector>

#include "planner/prediction/free_space_field.h"
#include "planner/prediction/ray_kernel.h"
#include "planner/prediction/surface_table.h"
#include "planner/prediction/view_predictor.h"

namespace nextview {

/// The same counts as PlainViewPredictor's, to the last ray, some twenty times sooner: the rays of
/// all orientations are tabulated once (their lines do not depend on where the sensor is), and walk
/// through a FreeSpaceField many at a time (ray_kernel.h). The table is sorted by where rays point,
/// not by whose they are, so that rays of different orientations that go the same way go together.
/// Threads share the tables between them, of several sensors at once where there are, and count
/// each for itself; sums of integers do not depend on how.
class FastViewPredictor : public RasterViewPredictor {
 public:
  /// @param threads how many may work at a time, at least 1
  /// @throws std::invalid_argument when there are no orientations, rays or threads, or a length is
  ///         not positive
  FastViewPredictor(const PredictionRaster& raster, double voxel_size_m,
                    std::vector<Orientation> orientations, bool counts_surfaces, int threads = 1);

  void predict(const KnownSpace& space, const VoxelIndex& sensor,
               std::span<ViewCounts> per_orientation) override;
  void predict_all(const KnownSpace& space, std::span<const VoxelIndex> sensors,
                   std::span<ViewCounts> counts) override;

 private:
  // Rays of all orientations that drive in the same direction.
  struct Table {
    RayBundle bundle;                            // its groups are orientations
    std::vector<QuantisedDirection> directions;  // world frame, by ray; for surface counts only
    std::vector<std::int32_t> occupied_at;       // where rays ended; for surface counts only
  };
  struct PacketOfView {
    std::size_t table;
    std::size_t packet;
  };
  // What one thread works with.
  struct Workspace {
    std::vector<RayCounts> counts;  // by sensor, then by orientation
    SurfaceCount surfaces;
  };
  // The jobs of a prediction are all tables from the first sensor, then all from the next. Each
  // thread begins with jobs of its own, the same number for all as far as that goes.
  std::size_t first_job(std::size_t thread, std::size_t jobs) const {
    return thread * jobs / workspaces_.size();
  }

  int threads() const { return static_cast<int>(workspaces_.size()); }
  void make_tables(const PredictionRaster& raster, double voxel_size_m);
  void predict_together(const KnownSpace& space, std::span<const VoxelIndex> sensors,
                        std::span<ViewCounts> counts);
  void fill_queues(std::size_t jobs);
  // What a thread does of the jobs: its own, then what others have left.
  void do_jobs(const FreeSpaceField& field, std::span<const VoxelIndex> sensors, std::size_t thread,
               Workspace& workspace);
  void add_up(std::span<const Workspace> workspaces, std::span<ViewCounts> counts) const;
  void cast(const FreeSpaceField& field, Table& table, PacketQueue& queue, const VoxelIndex& sensor,
            RayCounts* counts) const;
  void count_surfaces(const SurfaceTable& surfaces, std::size_t orientation, Workspace& workspace,
                      ViewCounts& counts) const;

  std::int64_t rays_per_view_;
  std::array<Table, 6> tables_;                        // by driving axis and sign
  std::vector<std::vector<PacketOfView>> packets_of_;  // by orientation; for surface counts only
  std::vector<Workspace> workspaces_;                  // by thread
  std::vector<PacketQueue> queues_;                    // by job
};

}  // namespace nextview
