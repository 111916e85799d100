#pragma once

#include <Eigen/Core>
#include <span>

namespace nextview {

/// What a path is like to travel.
struct Travel {
  double length_m = 0.0;
  /// Over its corners the sum of 1 - cos of the angle turned by: of none 0, of a right angle 1, of
  /// an about-turn 2.
  double turning = 0.0;
};

/// Along the straight pieces between waypoints, of which those that follow each other may be the
/// same.
Travel travel_along(std::span<const Eigen::Vector3d> waypoints_m);

}  // namespace nextview
