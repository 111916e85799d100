#include "sensor/sensor_config.h"

#include <algorithm>
#include <cstdint>

namespace nextview {

SensorGeometry sensor_of(const run_config_t& config) {
  SensorParameters parameters;
  std::ranges::copy(config.sensor.geometry_parameter, parameters.begin());
  return make_sensor(static_cast<SensorKind>(config.sensor.geometry), config.sensor.columns,
                     config.sensor.rows, parameters);
}

RangeLimits range_limits_of(const run_config_t& config) {
  return {.min_m = config.sensor.range_min_m, .max_m = config.sensor.range_max_m};
}

void fill_sensor(sensor_config_t& config, const SensorModel& sensor) {
  config.geometry = static_cast<std::int8_t>(kind_of(sensor.geometry));
  std::ranges::copy(parameters_of(sensor.geometry), config.geometry_parameter);
  config.columns = columns_of(sensor.geometry);
  config.rows = rows_of(sensor.geometry);
  config.range_min_m = sensor.limits.min_m;
  config.range_max_m = sensor.limits.max_m;
  config.range_noise_m = sensor.range_noise_m;
  config.scan_duration_s = sensor.scan_duration_s;
}

SensorPose start_pose_of(const run_config_t& config) {
  return {Eigen::Vector3d(config.base.start_m), config.base.start_pan_rad,
          config.base.start_tilt_rad};
}

}  // namespace nextview
