#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/voxel_grid.h"

namespace nextview {

/// Goes through the voxels of voxels_along, one after the other, for as long as asked to.
class SegmentWalk {
 public:
  SegmentWalk(const VoxelGrid& grid, const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m);

  const VoxelIndex& voxel() const { return voxel_; }
  /// Where the walk will end.
  const VoxelIndex& last() const { return last_; }
  bool at_end() const { return voxel_ == last_; }
  /// To the next voxel; not to be called at the end.
  void step();

 private:
  void find_boundary(int axis);

  VoxelGrid grid_;
  Eigen::Vector3d from_m_;
  Eigen::Vector3d to_m_;
  VoxelIndex voxel_;
  VoxelIndex last_;
  // Where on the segment the next voxel along each axis begins, 0 at from_m and 1 at to_m; infinite
  // when there is none.
  Eigen::Vector3d boundary_;
};

/// The voxels a straight segment passes through, from the voxel of one end to that of the other,
/// each sharing a face with the one before. Where the segment passes exactly through an edge or a
/// corner, the lower axis steps first.
std::vector<VoxelIndex> voxels_along(const VoxelGrid& grid, const Eigen::Vector3d& from_m,
                                     const Eigen::Vector3d& to_m);

}  // namespace nextview
