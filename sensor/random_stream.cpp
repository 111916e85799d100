#include "sensor/random_stream.h"

#include <cmath>
#include <numbers>

namespace nextview {

void RandomStream::seed_engine() {
  std::seed_seq sequence(seed_.begin(), seed_.end());
  engine_.emplace(sequence);
}

double RandomStream::gaussian() {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

}  // namespace nextview
