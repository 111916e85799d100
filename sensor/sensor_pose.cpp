#include "sensor/sensor_pose.h"

#include <cmath>

namespace nextview {

Eigen::Matrix3d world_from_sensor_rotation(double pan_rad, double tilt_rad) {
  const double sp = std::sin(pan_rad);
  const double cp = std::cos(pan_rad);
  const double st = std::sin(tilt_rad);
  const double ct = std::cos(tilt_rad);
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
