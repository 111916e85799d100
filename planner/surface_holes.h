#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/voxel_map.h"

namespace nextview {

/// An unknown voxel that shares a face with known free space.
struct HoleVoxel {
  VoxelIndex voxel;
  /// Mean of the directions in which Empty voxels lie, unit length; zero when they cancel.
  Eigen::Vector3d outward = Eigen::Vector3d::Zero();
  double trust = 1.0;  ///< that a view of it shows what it is, 0..1
};

/// A hole of the surface: where known free space ends and nothing was sensed.
struct SurfaceHole {
  std::vector<HoleVoxel> voxels;
};

/// The holes of a map's surface, found by its morphology (P24). With E the Empty voxels, U the
/// unknown ones (Unmarked, Occluded, OcclusionPlane) and B the cross of a voxel and its six
/// neighbours, the rim is (E dilated by B) and U; a hole is a set of its voxels that are connected
/// by faces, edges or corners. Around a room that is recovered whole the rim is empty; a gap in a
/// wall, a shadow on the floor and the way into the next room are each a hole.
///
/// A hole that is larger than a view takes in is given in parts: no voxel of a part is farther than
/// `largest_voxels` along an axis from the part's first.
/// @return in the order of their first voxels, x fastest; so are the voxels of a hole, but
/// connected
///         ones follow each other
/// @throws std::invalid_argument unless largest_voxels is positive
std::vector<SurfaceHole> surface_holes(const VoxelMap& map, int largest_voxels);

}  // namespace nextview
