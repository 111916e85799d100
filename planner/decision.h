#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "planner/fitness.h"
#include "planner/simplex.h"
#include "planner/termination.h"
#include "sensor/sensor_pose.h"

namespace nextview {

/// A position that was tried on the way to a decision (paper figure 6).
struct TriedPosition {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  double pan_rad = 0.0;  ///< best direction there; 0 when not feasible
  double tilt_rad = 0.0;
  double fitness = 0.0;  ///< best fitness there; -1 when not feasible
  SimplexMove move = SimplexMove::FirstVertex;
};

/// The next best view: where to go and why.
struct Decision {
  /// Of the positions tried no more are told: they have to fit one message.
  static constexpr std::size_t kMostTried = 1200;

  SensorPose pose;
  std::vector<Eigen::Vector3d> waypoints_m;  ///< present position first, pose.position_m last
  Fitness fitness;                           ///< predicted, at the pose
  std::string strategy;                      ///< that decided
  std::string reason;                        ///< in words, for people
  double expected_gain_m2 = 0.0;  ///< new surface the view is expected to show; 0: not estimated
  double overlap = 0.0;           ///< share of it that is known already; 0: not estimated
  int iterations = 0;             ///< of the search
  int evaluations = 0;            ///< positions tried; tried holds the first kMostTried
  std::vector<TriedPosition> tried;
};

/// There is no next view, and why.
struct Ending {
  StopReason reason;
  std::string detail;  ///< one sentence for people
};

using NextView = std::variant<Decision, Ending>;

}  // namespace nextview
