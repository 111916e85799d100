#include "sensor_sim/range_image.h"

#include <cmath>

namespace nextview {

float quantise_range(double range_m) { return static_cast<float>(std::round(range_m * 1e4) / 1e4); }

}  // namespace nextview
