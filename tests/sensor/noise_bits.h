#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "sensor/random_stream.h"

namespace nextview {

/// Mixes of the bits of many numbers.
struct NoiseBits {
  std::uint64_t noise = 0;  ///< of RandomStream::gaussian
  std::uint64_t libc = 0;   ///< of the C library's log and cos
};

inline NoiseBits noise_bits() {
  const auto mix = [](std::uint64_t& bits, double number) {
    bits = bits * 0x9e3779b97f4a7c15U + std::bit_cast<std::uint64_t>(number);
  };
  NoiseBits bits;
  RandomStream stream(11, 0, 0, RandomPurpose::RangeNoise);
  for (int i = 0; i < 200'000; ++i) {
    mix(bits.noise, stream.gaussian());
    const double uniform = 1.0 - stream.uniform();
    mix(bits.libc, std::log(uniform) + std::cos(6.0 * uniform));
  }
  return bits;
}

}  // namespace nextview
