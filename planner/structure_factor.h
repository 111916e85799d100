#pragma once

#include "planner/prediction/view_counts.h"

namespace nextview {

/// f_structure (P18), in [0, 1]: how well the overlap would tell where the sensor has moved.
///
///     f_structure = 3 lambda_min(N),  N = mean of n n^T over the distinct Occupied voxels met
///
/// n are their mean normals. A point that slides along its plane is no evidence, so of a
/// translation by t the overlap shows the mean of (n . t)^2 = t^T N t. lambda_min, the least of N's
/// eigenvalues, is that share in the direction of which it shows least; they sum to 1, so it is 1/3
/// at most. A corner of three planes seen alike has 1. A bare wall has 0, and so have two parallel
/// walls and an edge of two planes, along which everything can slide: a scan matcher that has only
/// those cannot tell (it is their point-to-plane Hessian that is singular). Of rotations nothing is
/// said. 0 when no Occupied voxel with a normal is met.
double structure_factor(const ViewCounts& counts);

}  // namespace nextview
