#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "mapper/map_builder.h"
#include "mapper/normal_slopes.h"
#include "mapper/voxel_map.h"
#include "sensor/range_image.h"

namespace nextview {

/// The map update as the paper tells it (P9, P11-P13), pixel by pixel and voxel by voxel, sharing
/// nothing between rays and visiting the whole window for planes and areas: the plain twin that
/// tests hold MapBuilder against.
class ReferenceMapUpdate {
 public:
  ReferenceMapUpdate(const VoxelGrid& grid, const MapWindow& window);

  /// @throws std::invalid_argument as MapBuilder::fold
  void fold(const RangeImage& image);

  /// As MapBuilder::move_window: what the window leaves is forgotten.
  void move_window(const VoxelIndex& new_min);

  /// Unmarked outside the window.
  Label label(const VoxelIndex& voxel) const;
  /// nullptr where no point was sensed.
  const SurfaceVoxel* surface(const VoxelIndex& voxel) const;
  MapStatistics statistics() const;

 private:
  std::size_t place(const VoxelIndex& voxel) const;
  void mark_free(const VoxelIndex& sensor, const VoxelIndex& end);
  void mark_hidden(const VoxelIndex& point, const VoxelIndex& limit);
  void label_occlusion_planes();
  int empty_neighbours(const VoxelIndex& voxel) const;

  VoxelGrid grid_;
  MapWindow window_;
  std::vector<Label> labels_;  ///< of the window, x fastest
  std::map<std::size_t, SurfaceVoxel> surfaces_;
};

/// The normal at pixel (u, v) of an image by the formulae of normals.h, from that pixel's
/// neighbours alone: the plain twin of NormalEstimator. All zero where there is none.
PointNormal reference_normal(const RangeImage& image, int u, int v);

}  // namespace nextview
