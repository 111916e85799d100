#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mapper/key_numbers.h"
#include "mapper/normals.h"
#include "mapper/pixel_runs.h"
#include "mapper/row_ends.h"
#include "mapper/voxel_map.h"
#include "sensor/range_image.h"

namespace nextview {

/// A voxel in which rays of a range image end. Rays from the same sensor to the same voxel are the
/// same voxel line, so one entry stands for all of them.
struct RayEnd {
  VoxelIndex voxel;
  bool is_surface;    ///< points were sensed in it; otherwise the line up to it is merely free
  SurfaceVoxel seen;  ///< of the points sensed in it by this image: normal sums, best quality
};

/// What rays hide: a line from the voxel of a point to the voxel where the point's ray leaves the
/// window (limit_of_ray). Rays that share both share the line.
struct Shadow {
  std::uint32_t end;  ///< a number among RayEnds::ends(), of a surface
  VoxelIndex limit;
};

/// How the pixels of a range image divide.
struct PixelCounts {
  std::int64_t points = 0;          ///< a point inside the window
  std::int64_t points_outside = 0;  ///< a point outside: the line towards it is free in the window
  std::int64_t no_returns = 0;      ///< RangeKind::NoReturn: free up to the largest range
  std::int64_t invalid = 0;         ///< RangeKind::Invalid: says nothing
};

/// Collects where the rays of an image end, with the normal and quality of every point.
/// One object serves many images, to reuse its memory.
class RayEnds {
 public:
  /// The image must be valid and its sensor inside the window (MapBuilder::fold checks both).
  void collect(const RangeImage& image, const VoxelGrid& grid, const MapWindow& window);

  /// The distinct ends, in the order of the first pixel that has each.
  std::span<const RayEnd> ends() const { return ends_; }
  /// The distinct lines beyond the surfaces, in the order of the first pixel that has each.
  std::span<const Shadow> shadows() const { return shadows_; }
  const PixelCounts& counts() const { return counts_; }
  std::size_t memory_bytes() const;

 private:
  void add_run(const PixelRun& run, const MapWindow& window);
  RayEnd& end_of(const PixelRun& run, const VoxelIndex& voxel, bool is_surface);
  std::uint32_t number_of(const VoxelIndex& voxel, bool is_surface);
  void add_shadow(int column, const RowEndFinder& finder);

  VoxelIndex sensor_;
  NormalEstimator normals_;
  NormalRow normal_row_;
  EndRow row_, row_above_;
  PixelRuns runs_;
  std::vector<RayEnd> ends_;
  /// By column, a number in ends_ that the pixel above, or here, is likely to end at.
  std::vector<std::uint32_t> end_above_, end_here_;
  KeyNumbers numbers_;  ///< of ends_
  std::vector<Shadow> shadows_;
  KeyNumbers shadow_numbers_;  ///< of shadows_
  PixelCounts counts_;
};

}  // namespace nextview
