#pragma once

#include <cstdint>
#include <vector>

#include "planner/prediction/free_space_field.h"
#include "planner/prediction/ray_kernel.h"
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
/// most along each side. Of the quality of surfaces nothing is counted.
class PanoramaViewPredictor : public RasterViewPredictor {
 public:
  static constexpr int kFaceSide = 64;  ///< 90 / 64 = 1.4 degrees a cell; a multiple of 8

  /// @param threads how many may work at a time, at least 1
  /// @throws std::invalid_argument when there are no orientations, rays or threads, or a length is
  ///         not positive
  PanoramaViewPredictor(const PredictionRaster& raster, double voxel_size_m,
                        std::vector<Orientation> orientations, int threads = 1);

  void predict(const KnownSpace& space, const VoxelIndex& sensor,
               std::span<ViewCounts> per_orientation) override;

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
    std::uint32_t begin;  // its WeightWords
    std::uint32_t end;
  };
  struct Panorama {
    std::vector<std::uint64_t> occupied;
    std::vector<std::uint64_t> occlusion_plane;
    std::vector<std::uint64_t> unseen;
  };

  void cast_face(const FreeSpaceField& field, std::size_t face, const VoxelIndex& sensor);
  void append_view(const RayTable& rays, const Orientation& orientation);
  static ViewCounts count(const Panorama& panorama, bool any_open, const WeightWord* begin,
                          const WeightWord* end);
  bool any_is_open() const;

  std::int64_t rays_per_view_;
  std::vector<RayBundle> faces_;
  std::vector<WeightWord> weights_;
  std::vector<View> views_;
  Panorama panorama_;
  int threads_;
};

}  // namespace nextview
