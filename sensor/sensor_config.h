#pragma once

#include "lcmtypes/channels.h"
#include "sensor/sensor_geometry.h"
#include "sensor/sensor_pose.h"

namespace nextview {

/// The sensor of a run.
TiltedLineScan sensor_of(const run_config_t& config);
RangeLimits range_limits_of(const run_config_t& config);

/// The pose of view 1.
SensorPose start_pose_of(const run_config_t& config);

}  // namespace nextview
