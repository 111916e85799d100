#include "planner/feasibility.h"

#include <cmath>

namespace nextview {

namespace {

// The least whole number that is not below a squared length of so many units.
int squared(double units) {
  // 0.3 / 0.1 is a little below 3: a length of whole voxels must not lose one to rounding.
  return static_cast<int>(std::ceil(units * units - 1e-6));
}

}  // namespace

VoxelNearness::VoxelNearness(double length_m, double voxel_size_m)
    : center_limit_(squared(length_m / voxel_size_m)),
      box_limit_(squared(2.0 * length_m / voxel_size_m)) {}

int VoxelNearness::reach() const { return static_cast<int>(std::ceil(std::sqrt(center_limit_))); }

void FeasibilityParameters::check() const {
  bounds::kClearance.require(clearance_m);
  if (body_radius_m != 0.0) bounds::kBodyRadius.require(body_radius_m);
  bounds::kDeparture.require(departure_m);
  for (int axis = 0; axis < 3; ++axis) {
    bounds::kWorkspace.require(workspace_min_m[axis]);
    bounds::kWorkspace.require(workspace_max_m[axis]);
    require_below("workspace_min_m", workspace_min_m[axis], "workspace_max_m",
                  workspace_max_m[axis]);
  }
  bounds::kLift.require(lift_min_m);
  bounds::kLift.require(lift_max_m);
  require_below("lift_min_m", lift_min_m, "lift_max_m", lift_max_m);
}

bool FeasibilityParameters::within_limits(const Eigen::Vector3d& position_m) const {
  return position_m.allFinite() && (position_m.array() >= workspace_min_m.array()).all() &&
         (position_m.array() <= workspace_max_m.array()).all() && position_m.z() >= lift_min_m &&
         position_m.z() <= lift_max_m;
}

}  // namespace nextview
