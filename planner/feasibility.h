#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <memory_resource>
#include <span>
#include <unordered_map>
#include <vector>

#include "mapper/voxel_map.h"
#include "planner/prediction/free_space_field.h"
#include "sensor/sensor_pose.h"

namespace nextview {

/// Where the sensor may go.
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
};

/// Answers where the sensor can go from where it is, in one state of the map (P19).
///
/// All distances are between voxel centres, the sensor's voxel standing for the sensor, so that
/// whether a position is feasible depends on its voxel only; the true distance of a sensed point
/// can be smaller by a voxel's diagonal at most. A position is reachable when
/// - it lies inside workspace and lift limits, and not near or behind a refused goal,
/// - every voxel of the straight segment from the present position is Empty,
/// - no Occupied voxel is nearer than clearance_m to any of them, and
/// - no unknown voxel (Unmarked, Occluded, OcclusionPlane) is nearer than body_radius_m to any of
///   them, those nearer than departure_m to the present voxel left out: the first scan sees only a
///   narrow cone, whose tip is too narrow for any body, from a place where the robot stands
///   already.
///
/// The present position itself is always reachable, whatever is near it: the robot is there. When
/// something turned out to be nearer than clearance_m to it, the path may begin within the
/// clearance, but must not come nearer to anything than the present position is, and once it has
/// got clear it must stay so.
///
/// A goal was refused because its path collides, and where on it is not known. So what is left out
/// is every position whose path passes a refused goal nearer than clearance_m (or half the distance
/// from the present position to the refused goal, where that is less).
class FeasibleSpace {
 public:
  /// The map must outlive this object and not change.
  /// @param present_m where the sensor is, inside the map's window
  /// @param refused goals of this view the base has refused
  /// @param field of the map; saves looking around where nothing is near. The answers do not depend
  ///        on it.
  /// @throws std::invalid_argument for parameters that cannot be or a present position outside
  FeasibleSpace(const VoxelMap& map, const FeasibilityParameters& parameters,
                const Eigen::Vector3d& present_m, std::span<const SensorPose> refused,
                const FreeSpaceField* field = nullptr);

  /// Whether the sensor may be at a position and get there straight from where it is.
  bool reachable(const Eigen::Vector3d& position_m);

 private:
  struct Surroundings {
    int nearest_occupied = 0;   // squared distance in voxels, at most clear_
    bool unknown_near = false;  // then nearest_occupied may be larger than it is
  };
  struct Offset {
    VoxelIndex step;
    int squared_length;
    int shell;  // the largest of |di|, |dj|, |dk|
  };

  void make_offsets(int limit);
  bool within_limits(const Eigen::Vector3d& position_m) const;
  bool is_refused(const Eigen::Vector3d& position_m) const;
  bool path_clear(const Eigen::Vector3d& position_m);
  bool is_clear(const Surroundings& near) const {
    return near.nearest_occupied == clear_ && !near.unknown_near;
  }
  // A neighbour that shares a face and is clear saves most of the work: only what the step from
  // there brings near for the first time is looked at.
  Surroundings surroundings(const VoxelIndex& voxel, const VoxelIndex* clear_neighbour);
  Surroundings look_around(const VoxelIndex& voxel, const std::vector<Offset>& offsets,
                           int free_distance) const;
  std::vector<Offset>& entered_by(int axis, int sign) {
    return entered_[static_cast<std::size_t>(2 * axis + (sign > 0 ? 1 : 0))];
  }

  const VoxelMap& map_;
  FeasibilityParameters parameters_;
  Eigen::Vector3d present_m_;
  VoxelIndex present_;
  std::vector<Eigen::Vector3d> refused_m_;
  int clear_;      // squared distances below this are nearer than the clearance; voxels
  int body_;       // the same for the body radius
  int departure_;  // and for the departure
  int reach_;      // the largest of |di|, |dj|, |dk| that is looked at
  const FreeSpaceField* field_;
  std::vector<Offset> offsets_;  // of all voxels nearer than clearance or body radius, by shell
  std::array<std::vector<Offset>, 6> entered_;  // those a step along an axis brings near, by step
  std::pmr::monotonic_buffer_resource memory_;  // of known_, which only grows
  std::pmr::unordered_map<std::size_t, Surroundings> known_{&memory_};  // by slot, where looked
  Surroundings at_present_;
};

}  // namespace nextview
