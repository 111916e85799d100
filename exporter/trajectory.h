#pragma once

#include <Eigen/Geometry>
#include <ostream>
#include <span>

namespace nextview {

/// Where a range image was taken, as the map believes it.
struct StampedPose {
  int view = 0;
  double time_s = 0.0;                                   ///< simulated, since the run's start
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< optical centre, world frame
  /// Takes the sensor frame (+x right, +y forward, +z up) to the world frame.
  Eigen::Matrix3d world_from_sensor = Eigen::Matrix3d::Identity();
};

/// The rotation as the quaternion with w >= 0.
Eigen::Quaterniond quaternion_of(const StampedPose& pose);

/// A row a view with a heading: view, time_s, x_m, y_m, z_m, pan_deg, tilt_deg, qx, qy, qz, qw.
/// Pan and tilt are those of the rotation (SensorPose).
void write_poses_csv(std::ostream& out, std::span<const StampedPose> poses);

/// The trajectory format of the TUM RGB-D benchmark: a line a view, "time_s x y z qx qy qz qw".
void write_poses_tum(std::ostream& out, std::span<const StampedPose> poses);

}  // namespace nextview
