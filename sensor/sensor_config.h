#pragma once

#include "lcmtypes/channels.h"
#include "sensor/sensor_geometry.h"

namespace nextview {

/// The sensor of a run.
TiltedLineScan sensor_of(const run_config_t& config);
RangeLimits range_limits_of(const run_config_t& config);

}  // namespace nextview
