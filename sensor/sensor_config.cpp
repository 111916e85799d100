#include "sensor/sensor_config.h"

namespace nextview {

TiltedLineScan sensor_of(const run_config_t& config) {
  return {.columns = config.sensor.columns,
          .rows = config.sensor.rows,
          .horizontal_aperture_rad = config.sensor.geometry_parameter[0],
          .vertical_aperture_rad = config.sensor.geometry_parameter[1]};
}

RangeLimits range_limits_of(const run_config_t& config) {
  return {.min_m = config.sensor.range_min_m, .max_m = config.sensor.range_max_m};
}

SensorPose start_pose_of(const run_config_t& config) {
  return {Eigen::Vector3d(config.base.start_m), config.base.start_pan_rad,
          config.base.start_tilt_rad};
}

}  // namespace nextview
