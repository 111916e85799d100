#pragma once

#include <Eigen/Core>

#include "lcmtypes/parameter_bounds.h"
#include "mapper/voxel_grid.h"

namespace nextview {

/// How near a voxel is that lies some steps away, as seen from a voxel's centre. What is Occupied
/// counts as being at its voxel's centre, as in the paper (P19). What is unknown may be anywhere in
/// its voxel, so its box counts: measured to the centre, half a voxel of the body could stand in
/// what nobody has seen.
class VoxelNearness {
 public:
  explicit VoxelNearness(double length_m, double voxel_size_m);

  /// Whether the voxel's centre is nearer than the length.
  bool center_is_nearer(const VoxelIndex& step) const { return step.squaredNorm() < center_limit_; }
  /// Whether a point of its box is.
  bool box_is_nearer(const VoxelIndex& step) const {
    const VoxelIndex half_voxels = (2 * step.cwiseAbs() - VoxelIndex::Ones()).cwiseMax(0);
    return half_voxels.squaredNorm() < box_limit_;
  }

  /// The least squared distance between centres, in voxels, that is not nearer than the length.
  int center_limit() const { return center_limit_; }
  /// No voxel farther than this along an axis is nearer, neither its centre nor its box.
  int reach() const;

 private:
  int center_limit_;  // squared voxels
  int box_limit_;     // squared half voxels
};

/// Where the sensor may go (P19 and the body rule). A position is feasible when
/// - it lies inside workspace and lift limits, in an Empty voxel,
/// - no Occupied voxel is nearer than clearance_m, and
/// - no box of an unknown voxel (Unmarked, Occluded, OcclusionPlane) is nearer than body_radius_m,
///
/// and reachable when a path of such positions leads there. The present position itself is always
/// reachable: the robot is there; ShortestPaths says how it may leave.
///
/// The centre of the sensor's voxel stands for the sensor, so that whether a position is feasible
/// depends on its voxel only. The true distance of a sensed point can be smaller than the clearance
/// by a voxel's diagonal at most.
struct FeasibilityParameters {
  static constexpr double kUnlimited = bounds::kWorkspace.most;  ///< there is nothing beyond

  double clearance_m = 0.40;    ///< no Occupied voxel nearer to the sensor or its path (P19)
  double body_radius_m = 0.20;  ///< nor anything unknown; 0: unknown space may be near
  double departure_m = 1.00;  ///< but unknown voxels this near to where the sensor is do not count
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
