#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <random>

namespace nextview {

/// What random numbers are drawn for; keeps the streams of one view apart. Never renumber.
enum class RandomPurpose : std::uint32_t {
  RangeNoise = 1,
  InitialSimplex = 2,
};

/// A stream of random numbers that depends on (seed, view, attempt, purpose) alone.
///
/// The engine and its seeding are those of the C++ standard, which fixes every bit of both; the
/// standard's distributions are not fixed, so the mappings to numbers are here.
class RandomStream {
 public:
  RandomStream(std::int64_t seed, int view, int attempt, RandomPurpose purpose)
      : seed_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
              static_cast<std::uint32_t>(view), static_cast<std::uint32_t>(attempt),
              static_cast<std::uint32_t>(purpose)} {}

  /// Uniform in [0, 1), a multiple of 2^-53.
  double uniform() { return static_cast<double>(draw() >> 11) * 0x1.0p-53; }

  /// Uniform in {0, ..., count - 1}; count > 0. Lemire's multiplication, its bias below 2^-32.
  std::uint32_t below(std::uint32_t count) {
    return static_cast<std::uint32_t>(((draw() >> 32) * count) >> 32);
  }

  /// Standard normal (Marsaglia's polar method). Made of operations that IEEE 754 rounds one way,
  /// so that noise is the same on every processor.
  double gaussian();

 private:
  // Seeded by the first draw: seeding takes as long as casting two hundred rays, and a scan without
  // noise draws nothing.
  std::uint64_t draw() {
    if (!engine_) seed_engine();
    return (*engine_)();
  }
  void seed_engine();

  std::array<std::uint32_t, 5> seed_;
  std::optional<std::mt19937_64> engine_;
};

}  // namespace nextview
