#pragma once

#include <Eigen/Geometry>
#include <array>
#include <stop_token>
#include <vector>

#include "mapper/voxel_grid.h"
#include "scene/triangle_mesh.h"

namespace nextview {

/// Whether a triangle and a closed box have a point in common (separating axes, in double).
bool triangle_meets_box(const std::array<Eigen::Vector3d, 3>& corners_m,
                        const Eigen::AlignedBox3d& box);

/// The voxels of a window with surface of the CAD model in or beside them: a triangle meets the
/// voxel's own closed cube or that of one of its 26 neighbours.
class NearSurface {
 public:
  /// Incomplete, and to be thrown away, when stop is requested.
  NearSurface(const TriangleMesh& mesh, const VoxelGrid& grid, const MapWindow& window,
              const std::stop_token& stop = {});

  /// Of a voxel outside the window: false.
  bool holds(const VoxelIndex& voxel) const {
    return window_.contains(voxel) && holds_[number_of(voxel)];
  }

 private:
  std::size_t number_of(const VoxelIndex& voxel) const;

  MapWindow window_;
  std::vector<bool> holds_;  ///< by number_of
};

}  // namespace nextview
