#include "sensor/random_stream.h"

#include <cmath>
#include <numbers>

namespace nextview {

namespace {

// The natural logarithm of a positive number, within 2^-52 of itself or of 1. The C library's may
// differ in its last bit from processor to processor; of what is done here IEEE 754 fixes every
// bit.
double logarithm(double x) {
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);
  if (mantissa < std::numbers::sqrt2 / 2.0) {
    mantissa *= 2.0;
    --exponent;
  }
  // log m = 2 artanh((m - 1) / (m + 1)), where the quotient is 0.172 at most: the first term left
  // out is below 2^-57.
  const double z = (mantissa - 1.0) / (mantissa + 1.0);
  const double square = z * z;
  double sum = 0.0;
  for (int power = 21; power > 1; power -= 2) sum = (sum + 1.0 / power) * square;
  return static_cast<double>(exponent) * std::numbers::ln2 + 2.0 * (z + z * sum);
}

}  // namespace

void RandomStream::seed_engine() {
  std::seed_seq sequence(seed_.begin(), seed_.end());
  engine_.emplace(sequence);
}

double RandomStream::gaussian() {
  // A point of the unit disk without its centre: its angle is uniform, and so is its radius
  // squared.
  double along = 0.0;
  double square = 0.0;
  do {
    along = 2.0 * uniform() - 1.0;
    const double across = 2.0 * uniform() - 1.0;
    square = along * along + across * across;
  } while (square >= 1.0 || square == 0.0);
  return along * std::sqrt(-2.0 * logarithm(square) / square);
}

}  // namespace nextview
