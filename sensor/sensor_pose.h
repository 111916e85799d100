#pragma once

#include <Eigen/Core>

namespace nextview {

/// Where the range sensor is and where it looks: the five degrees of freedom of the view planning
/// problem (paper section 3, P1). No roll.
struct SensorPose {
  /// Optical centre in the world frame (right-handed, z up), metres.
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  /// Rotation about the world's z axis, radians; 0 looks along +y, positive turns left.
  double pan_rad = 0.0;
  /// Elevation of the optical axis, radians in [-pi/2, pi/2]; positive looks up. The paper's tilt
  /// is this + 90 degrees.
  double tilt_rad = 0.0;
};

/// The rotation Rz(pan) · Rx(tilt) that takes sensor coordinates (+x right, +y forward, +z up) to
/// world coordinates. Uses the platform's sin and cos, so send the matrix and not the angles where
/// every bit counts.
Eigen::Matrix3d world_from_sensor_rotation(double pan_rad, double tilt_rad);

/// The optical axis of a sensor with these angles, as a unit vector of the world frame.
Eigen::Vector3d viewing_direction(double pan_rad, double tilt_rad);

}  // namespace nextview
