#include "planner/segment_walk.h"

#include <limits>

namespace nextview {

SegmentWalk::SegmentWalk(const VoxelGrid& grid, const Eigen::Vector3d& from_m,
                         const Eigen::Vector3d& to_m)
    : grid_(grid),
      from_m_(from_m),
      to_m_(to_m),
      voxel_(grid.voxel_of(from_m)),
      last_(grid.voxel_of(to_m)) {
  for (int axis = 0; axis < 3; ++axis) find_boundary(axis);
}

void SegmentWalk::find_boundary(int axis) {
  if (voxel_[axis] == last_[axis]) {
    boundary_[axis] = std::numeric_limits<double>::infinity();
    return;
  }
  const double side = last_[axis] > voxel_[axis] ? 0.5 : -0.5;
  const double boundary_m =
      grid_.origin_m[axis] + (static_cast<double>(voxel_[axis]) + side) * grid_.voxel_size_m;
  boundary_[axis] = (boundary_m - from_m_[axis]) / (to_m_[axis] - from_m_[axis]);
}

void SegmentWalk::step() {
  int axis = 0;
  boundary_.minCoeff(&axis);
  voxel_[axis] += last_[axis] > voxel_[axis] ? 1 : -1;
  find_boundary(axis);
}

std::vector<VoxelIndex> voxels_along(const VoxelGrid& grid, const Eigen::Vector3d& from_m,
                                     const Eigen::Vector3d& to_m) {
  SegmentWalk walk(grid, from_m, to_m);
  std::vector<VoxelIndex> voxels = {walk.voxel()};
  while (!walk.at_end()) {
    walk.step();
    voxels.push_back(walk.voxel());
  }
  return voxels;
}

}  // namespace nextview
