#include "sensor/random_stream.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <string>

#include "tests/sensor/noise_bits.h"

namespace nextview {
namespace {

// Fixed for good: a run of yesterday must repeat with the library of tomorrow.
TEST(RandomStream, FirstNumbersNeverChange) {
  RandomStream stream(1, 2, 3, RandomPurpose::InitialSimplex);
  EXPECT_EQ(stream.uniform(), 0x1.30232d6d71125p-1);
  EXPECT_EQ(stream.uniform(), 0x1.cb71ebaa02e2dp-1);
  EXPECT_EQ(stream.below(20), 11U);
  EXPECT_EQ(stream.below(20), 14U);
}

TEST(RandomStream, FirstGaussiansNeverChange) {
  RandomStream stream(1, 2, 3, RandomPurpose::RangeNoise);
  for (const double expected :
       {-0x1.07ec988435e81p+0, 0x1.2a5d1b04ce652p+1, 0x1.1cefd927af1cfp+0, -0x1.a0e86c7696917p+0,
        0x1.fb755da8d619bp-1, -0x1.bf7d0173ac71p-1, 0x1.749e53239f4fdp-2, 0x1.a88ee949538bp-1}) {
    EXPECT_EQ(stream.gaussian(), expected);
  }
}

TEST(RandomStream, DependsOnSeedViewAttemptAndPurpose) {
  const auto first = [](std::int64_t seed, int view, int attempt, RandomPurpose purpose) {
    return RandomStream(seed, view, attempt, purpose).uniform();
  };
  const double reference = first(1, 2, 3, RandomPurpose::RangeNoise);
  EXPECT_EQ(first(1, 2, 3, RandomPurpose::RangeNoise), reference);
  EXPECT_NE(first(2, 2, 3, RandomPurpose::RangeNoise), reference);
  EXPECT_NE(first(1 + (std::int64_t{1} << 32), 2, 3, RandomPurpose::RangeNoise), reference);
  EXPECT_NE(first(1, 3, 3, RandomPurpose::RangeNoise), reference);
  EXPECT_NE(first(1, 2, 4, RandomPurpose::RangeNoise), reference);
  EXPECT_NE(first(1, 2, 3, RandomPurpose::InitialSimplex), reference);
}

TEST(RandomStream, BelowIsEvenAndInRange) {
  RandomStream stream(7, 0, 0, RandomPurpose::InitialSimplex);
  int counts[20] = {};
  for (int i = 0; i < 20000; ++i) {
    const std::uint32_t number = stream.below(20);
    ASSERT_LT(number, 20U);
    ++counts[number];
  }
  for (const int count : counts) {
    EXPECT_NEAR(count, 1000, 150);  // five standard deviations
  }
}

TEST(RandomStream, GaussianIsThePolarMethodWithTheLibrarysLogarithm) {
  RandomStream stream(3, 0, 0, RandomPurpose::RangeNoise);
  RandomStream uniforms(3, 0, 0, RandomPurpose::RangeNoise);
  int close = 0;
  for (; close < 100000; ++close) {
    long double along = 0.0L;
    long double square = 0.0L;
    do {
      along = 2.0L * uniforms.uniform() - 1.0L;
      const long double across = 2.0L * uniforms.uniform() - 1.0L;
      square = along * along + across * across;
    } while (square >= 1.0L || square == 0.0L);
    const long double expected = along * std::sqrt(-2.0L * std::log(square) / square);
    ASSERT_NEAR(stream.gaussian(), static_cast<double>(expected), 1e-14);
  }
  EXPECT_EQ(close, 100000);
}

TEST(RandomStream, GaussianIsStandardNormal) {
  RandomStream stream(7, 0, 0, RandomPurpose::RangeNoise);
  constexpr int kCount = 1'000'000;
  double sums[5] = {};  // of powers
  int below[9] = {};    // of -4, -3, ... 4
  int correlated = 0;   // how often one number has the sign of the last
  double last = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double number = stream.gaussian();
    for (int power = 1; power < 5; ++power) sums[power] += std::pow(number, power);
    for (int limit = -4; limit <= 4; ++limit) below[limit + 4] += number < limit;
    correlated += number * last > 0.0;
    last = number;
  }
  // Five standard deviations each: the variance of the n-th power's mean is
  // (E x^2n - (E x^n)^2) / kCount.
  const double root = std::sqrt(kCount);
  EXPECT_NEAR(sums[1] / kCount, 0.0, 5.0 * 1.0 / root);
  EXPECT_NEAR(sums[2] / kCount, 1.0, 5.0 * std::sqrt(2.0) / root);
  EXPECT_NEAR(sums[3] / kCount, 0.0, 5.0 * std::sqrt(15.0) / root);
  EXPECT_NEAR(sums[4] / kCount, 3.0, 5.0 * std::sqrt(96.0) / root);
  EXPECT_NEAR(correlated, 0.5 * kCount, 5.0 * 0.5 * root);
  for (int limit = -4; limit <= 4; ++limit) {
    const double share = 0.5 * std::erfc(-limit / std::sqrt(2.0));
    const double deviation = std::sqrt(share * (1.0 - share) * kCount);
    EXPECT_NEAR(below[limit + 4], share * kCount, 5.0 * deviation) << limit;
  }
}

// The C library chooses its log and cos by what the processor can do, and so may seem another
// processor's: without fused multiplication its logarithms differ in their last bits.
TEST(RandomStream, GaussianDoesNotDependOnTheProcessor) {
  const auto noise_with = [](const std::string& tunables) {
    const std::string command = "GLIBC_TUNABLES=" + tunables + " " NEXTVIEW_NOISE_PROGRAM;
    std::FILE* const pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) throw std::runtime_error("cannot run " + command);
    char line[256] = {};
    const bool read = std::fgets(line, sizeof(line), pipe) != nullptr;
    if (pclose(pipe) != 0 || !read) throw std::runtime_error(command + " failed");
    NoiseBits bits;
    std::istringstream(line) >> bits.noise >> bits.libc;
    return bits;
  };
  const NoiseBits as_it_is = noise_with("");
  // By their names before glibc 2.33 and since.
  const NoiseBits without = noise_with(
      "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX512F,-FMA_Usable,-FMA4_Usable,-AVX2_Usable");
  EXPECT_EQ(as_it_is.noise, noise_bits().noise);
  EXPECT_EQ(without.noise, as_it_is.noise);
  if (without.libc == as_it_is.libc) {
    GTEST_SKIP() << "here the C library's own log and cos do not differ either: the processor has "
                    "no FMA, or the library cannot be told that it has none";
  }
}

}  // namespace
}  // namespace nextview
