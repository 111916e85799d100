#include "sensor/sensor_pose.h"

#include "sensor/elementary_functions.h"

namespace nextview {

Eigen::Matrix3d world_from_sensor_rotation(double pan_rad, double tilt_rad) {
  const double sp = elementary::sin(pan_rad);
  const double cp = elementary::cos(pan_rad);
  const double st = elementary::sin(tilt_rad);
  const double ct = elementary::cos(tilt_rad);
  Eigen::Matrix3d rotation;
  rotation << cp, -sp * ct, sp * st,  //
      sp, cp * ct, -cp * st,          //
      0.0, st, ct;
  return rotation;
}

Eigen::Vector3d viewing_direction(double pan_rad, double tilt_rad) {
  return world_from_sensor_rotation(pan_rad, tilt_rad).col(1);
}

}  // namespace nextview
