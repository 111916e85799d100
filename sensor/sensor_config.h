#pragma once

#include "lcmtypes/channels.h"
#include "sensor/sensor_geometry.h"
#include "sensor/sensor_pose.h"

namespace nextview {

/// The sensor of a run.
/// @throws std::invalid_argument for a geometry that is none; check() has refused those
SensorGeometry sensor_of(const run_config_t& config);
RangeLimits range_limits_of(const run_config_t& config);

/// Says which sensor a run has.
void fill_sensor(sensor_config_t& config, const SensorModel& sensor);

/// The pose of view 1.
SensorPose start_pose_of(const run_config_t& config);

}  // namespace nextview
