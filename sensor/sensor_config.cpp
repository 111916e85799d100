#include "sensor/sensor_config.h"

namespace nextview {

TiltedLineScan sensor_of(const run_config_t& config) {
  return {.columns = config.columns,
          .rows = config.rows,
          .horizontal_aperture_rad = config.horizontal_aperture_rad,
          .vertical_aperture_rad = config.vertical_aperture_rad};
}

RangeLimits range_limits_of(const run_config_t& config) {
  return {.min_m = config.range_min_m, .max_m = config.range_max_m};
}

}  // namespace nextview
