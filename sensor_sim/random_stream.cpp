#include "sensor_sim/random_stream.h"

#include <cmath>
#include <numbers>

namespace nextview {

double RandomStream::gaussian() {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

}  // namespace nextview
