#include "sensor/random_stream.h"

#include <gtest/gtest.h>

#include <cmath>

namespace nextview {
namespace {

// Fixed for good: a run of yesterday must repeat with the library of tomorrow.
TEST(RandomStream, FirstNumbersNeverChange) {
  RandomStream stream(1, 2, 3, RandomPurpose::InitialSimplex);
  EXPECT_EQ(stream.uniform(), 0x1.30232d6d71125p-1);
  EXPECT_EQ(stream.uniform(), 0x1.cb71ebaa02e2dp-1);
  EXPECT_EQ(stream.below(20), 11U);
  EXPECT_EQ(stream.below(20), 14U);
  EXPECT_NEAR(stream.gaussian(), 1.2306210799022481, 1e-14);  // log and cos are the platform's
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

TEST(RandomStream, GaussianHasMeanZeroAndDeviationOne) {
  RandomStream stream(7, 0, 0, RandomPurpose::RangeNoise);
  constexpr int kCount = 100000;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double number = stream.gaussian();
    sum += number;
    squares += number * number;
  }
  EXPECT_NEAR(sum / kCount, 0.0, 0.016);  // five standard deviations
  EXPECT_NEAR(std::sqrt(squares / kCount), 1.0, 0.012);
}

}  // namespace
}  // namespace nextview
