#pragma once

#include "exporter/oriented_points.h"
#include "exporter/surface_mesh.h"
#include "mapper/voxel_map.h"

namespace nextview {

/// The surface between Empty and Occupied voxels (P14): Marching Cubes over the voxel centres, free
/// where a voxel is Empty and solid elsewhere, its vertices moved onto the planes of the sensed
/// points nearby. Triangles are about voxel-sized.
///
/// - Closed where the surface was seen: the mesh ends nowhere at the face of an Occupied voxel, but
///   within a voxel beyond, where what is behind Empty was never seen.
/// - Wound consistently, counter-clockwise seen from the free side: neighbours run along their
/// common
///   edge in opposite directions.
/// - No triangle is lower than a hundredth of a voxel: a vertex whose move would flatten one, or
///   turn it over, is moved less.
/// - Of one voxel only, holes are filled (P24, one_voxel_holes.h) and crumbs taken away: an unseen
///   voxel counts as Empty when both its neighbours along two axes at least are. The map itself
///   stays as it is.
SurfaceMesh recovered_mesh(const VoxelMap& map, const OrientedPoints& points);

}  // namespace nextview
