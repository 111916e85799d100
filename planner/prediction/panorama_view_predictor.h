#pragma once

#include <cstdint>
#include <vector>

#include "planner/prediction/free_space_field.h"
#include "planner/prediction/ray_kernel.h"
#include "planner/prediction/surface_table.h"
#include "planner/prediction/view_predictor.h"

namespace nextview {

/// Predicts the views of very many orientations from one cast all around the sensor.
///
/// The directions around a point are the cells of a cube's faces, kFaceSide x kFaceSide each,
/// evenly spaced in angle. One ray is cast per cell, and what it met is one bit of three sets. A
/// view is a fixed set of cells with weights: each of its rays counts for the cell it lies in. So a
/// view's counts are populations of bit sets:
///
///     occupied = sum over p of 2^p |met Occupied  AND  cells whose weight has bit p|
///
/// and of these words of 64 cells only the two dozen a view covers are looked at. Where no ray of
/// the panorama is open, as in most rooms, what is unseen is what is left. Counts differ from
/// PlainViewPredictor's as the direction of a ray is rounded to its cell's, by 1.4 degrees / 2 at
/// most along each side; with the rays that rays() says it counts the same.
///
/// Surfaces are counted over the cells of a view that have any weight: what each of the panorama's
/// cells meets is looked up once, for all views.
class PanoramaViewPredictor : public RasterViewPredictor {
 public:
  static constexpr int kFaceSide = 64;  ///< 90 / 64 = 1.4 degrees a cell; a multiple of 8

  /// @param threads how many may work at a time, at least 1
  /// @throws std::invalid_argument when there are no orientations, rays or threads, or a length is
  ///         not positive
  PanoramaViewPredictor(const PredictionRaster& raster, double voxel_size_m,
                        std::vector<Orientation> orientations, bool counts_surfaces,
                        int threads = 1);

  /// The rays it counts, unit vectors of the world frame: for each orientation as many as the
  /// raster has, each the middle of its cell.
  std::vector<Eigen::Vector3d> rays() const;

  void predict(const KnownSpace& space, const VoxelIndex& sensor,
               std::span<ViewCounts> per_orientation) override;
  /// Casts all cells: a few dozen views cover nearly all of them.
  void look_from(const KnownSpace& space, const VoxelIndex& sensor) override;
  /// Adds up the cells of these views alone.
  void count(std::span<const std::size_t> which, std::span<ViewCounts> counts) override;

 private:
  static constexpr int kCells = 6 * kFaceSide * kFaceSide;
  static constexpr int kWords = kCells / 64;

  // 64 cells of a view: bit plane p holds bit p of each cell's weight.
  struct WeightWord {
    std::uint32_t word;   // of the panorama
    std::uint32_t plane;  // p
    std::uint64_t cells;
  };
  struct View {
    std::uint32_t begin;  // its WeightWords, those of a word side by side
    std::uint32_t end;
  };
  // What the ray of a cell that meets an Occupied voxel does there.
  struct Sighting {
    std::uint32_t surface;
    std::int32_t cosine;
  };
  struct Panorama {
    std::vector<std::uint64_t> occupied;
    std::vector<std::uint64_t> occlusion_plane;
    std::vector<std::uint64_t> unseen;
    std::vector<std::int32_t> occupied_at;  // by cell; these two for surface counts only
    std::vector<Sighting> sightings;        // by cell; of those that met nothing Occupied as it was
  };

  void cast_face(const FreeSpaceField& field, std::size_t face, const VoxelIndex& sensor);
  void look_up(const SurfaceTable& surfaces, std::size_t face);
  void append_view(const RayTable& rays, const Orientation& orientation);
  static ViewCounts count_cells(const Panorama& panorama, bool any_open, const WeightWord* begin,
                                const WeightWord* end);
  void count_surfaces(const SurfaceTable& surfaces, const View& view, SurfaceCount& count,
                      ViewCounts& counts) const;
  bool any_is_open() const;
  int threads() const { return static_cast<int>(surface_counts_.size()); }

  std::int64_t rays_per_view_;
  std::vector<RayBundle> faces_;
  std::vector<WeightWord> weights_;
  std::vector<View> views_;
  std::vector<std::size_t> all_views_;
  Panorama panorama_;                       // of the last look_from(), as are the next two
  const SurfaceTable* surfaces_ = nullptr;  // null unless they are counted
  bool any_open_ = false;
  std::vector<QuantisedDirection> directions_;  // by cell; for surface counts only
  std::vector<SurfaceCount> surface_counts_;    // by thread
};

}  // namespace nextview
