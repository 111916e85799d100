#pragma once

#include <vector>

#include "mapper/voxel_map.h"

namespace nextview {

/// Holes of one voxel in the sensed surface, which tidying up may fill without another view (P24).
///
/// With C_x, C_y, C_z the Occupied voxels closed along one axis each, morphologically, by a segment
/// of three voxels, a voxel is a gap when it is not Occupied itself, lies in two of the three, and
/// is Empty or shares a face with an Empty voxel: what nobody can look at is no hole. A gap that
/// shares no face with another one is a hole of one voxel. So a single voxel that is missing in a
/// wall, a floor or a thick slab is one; two beside each other, a slit, a pipe and a door are not.
///
/// Filling is for what is made of a map, meshes and files. A map holds what was sensed: nothing
/// here changes one, and no planner or digest sees what was filled.
bool is_one_voxel_hole(const VoxelMap& map, const VoxelIndex& voxel);

/// All of them, x fastest.
std::vector<VoxelIndex> one_voxel_holes(const VoxelMap& map);

}  // namespace nextview
