#pragma once

#include <Eigen/Core>
#include <limits>

namespace nextview {

/// Where the sensor may go (P19 and the body rule). A position is feasible when
/// - it lies inside workspace and lift limits, in an Empty voxel,
/// - no Occupied voxel is nearer than clearance_m, and
/// - no unknown voxel (Unmarked, Occluded, OcclusionPlane) is nearer than body_radius_m,
///
/// and reachable when a path of such positions leads there. The present position itself is always
/// reachable: the robot is there; ShortestPaths says how it may leave.
///
/// The centre of the sensor's voxel stands for the sensor, so that whether a position is feasible
/// depends on its voxel only, and distances are between voxel centres: the true distance of a
/// sensed point can be smaller by a voxel's diagonal at most.
struct FeasibilityParameters {
  static constexpr double kUnlimited = std::numeric_limits<double>::infinity();

  double clearance_m = 0.40;    ///< no Occupied voxel nearer to the sensor or its path (P19)
  double body_radius_m = 0.20;  ///< nothing unknown nearer either; 0: unknown space may be near
  double departure_m = 0.80;  ///< but unknown voxels this near to where the sensor is do not count
  Eigen::Vector3d workspace_min_m = Eigen::Vector3d::Constant(-kUnlimited);  ///< world frame
  Eigen::Vector3d workspace_max_m = Eigen::Vector3d::Constant(kUnlimited);
  double lift_min_m = -kUnlimited;  ///< sensor height, world z
  double lift_max_m = kUnlimited;

  /// @throws std::invalid_argument naming the parameter that cannot be
  void check() const;

  /// Whether a position lies inside workspace and lift limits.
  bool within_limits(const Eigen::Vector3d& position_m) const;
};

}  // namespace nextview
