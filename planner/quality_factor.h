#pragma once

#include "planner/prediction/view_counts.h"

namespace nextview {

/// f_quality (P17), in [0, 1]: (share of the distinct Occupied voxels met that would improve) x
/// (their mean improvement). 0 when no Occupied voxel is met.
double quality_factor(const ViewCounts& counts);

}  // namespace nextview
