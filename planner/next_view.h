#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mapper/voxel_map.h"
#include "planner/feasibility.h"
#include "planner/fitness.h"
#include "planner/prediction/view_predictor.h"
#include "planner/simplex.h"
#include "sensor/sensor_pose.h"

namespace nextview {

/// How the next best view is looked for (P19-P22).
struct PlannerParameters {
  bool use_quality = false;  ///< f_quality in the fitness (eq. 4)
  double step_min_m = 0.3;   ///< distance of the initial simplex's vertices from the first ...
  double step_max_m = 3.0;   ///< ... is drawn from this range
  double fitness_tolerance = 0.01;  ///< the simplex stops when its fitness range falls below
  int max_evaluations = 70;         ///< or after this many positions
  FeasibilityParameters feasibility;

  /// @throws std::invalid_argument naming the parameter that cannot be
  void check() const;
};

/// A position the simplex tried (paper figure 6).
struct TriedPosition {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  double pan_rad = 0.0;  ///< best direction there; 0 when not feasible
  double tilt_rad = 0.0;
  double fitness = 0.0;  ///< best fitness there; -1 when not feasible
  SimplexMove move = SimplexMove::FirstVertex;
};

/// The next best view: where to go and why.
struct Decision {
  SensorPose pose;
  std::vector<Eigen::Vector3d> waypoints_m;  ///< present position first, pose.position_m last
  Fitness fitness;                           ///< predicted, at the pose
  int iterations = 0;                        ///< of the simplex
  int evaluations = 0;                       ///< positions tried, = tried.size()
  std::vector<TriedPosition> tried;
};

/// Decides the next best view: hill climbing over positions with a simplex (P21), at each position
/// exhaustively over the predictor's orientations (P20), as far as the known map lets the robot go
/// (P19). A pure function of its arguments, as long as the predictor knows of every change of the
/// map.
///
/// A position's fitness is that of its voxel, best over the orientations, ties to the lowest index.
/// In the voxel the sensor stands in, the orientation it has just scanned with is left out.
///
/// @param present the pose the last range image was taken from
/// @param view, attempt with the seed they give the random numbers of the initial simplex
/// @param refused goals of this view that the base has refused; they and what lies near them or
///        behind them are left out
/// @return nothing when no position is feasible
/// @throws std::invalid_argument for parameters that cannot be, a present position outside the
///         map's window, or a predictor that does not count the quality that is asked for
std::optional<Decision> decide_next_view(const VoxelMap& map, ViewPredictor& predictor,
                                         const PlannerParameters& parameters,
                                         const SensorPose& present, std::int64_t seed, int view,
                                         int attempt, std::span<const SensorPose> refused);

}  // namespace nextview
