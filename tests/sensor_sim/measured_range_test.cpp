#include "sensor_sim/measured_range.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/scene/test_worlds.h"

namespace nextview {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

const RangeLimits kLimits[] = {{0.05, 30.0},  {0.0, 5.0},      {0.0, 0.0},    {1.0, 1.0},
                               {0.1, 2000.0}, {0.0, 199999.9}, {0.0, 2e5},    {0.0, 2.00001e5},
                               {5.0, 1e9},    {0.0, 1e15},     {0.05F, 30.1F}};

// Counts the distances whose range is not, to the last bit, that of measured_range.
int differing(const std::vector<float>& distance_m, const RangeLimits& limits) {
  std::vector<float> range_m = distance_m;
  measure_ranges(limits, range_m);
  int differ = 0;
  for (std::size_t i = 0; i < distance_m.size(); ++i) {
    const float plain_m = measured_range(static_cast<double>(distance_m[i]), limits);
    differ += std::bit_cast<std::uint32_t>(range_m[i]) != std::bit_cast<std::uint32_t>(plain_m);
  }
  return differ;
}

void push_with_neighbours(std::vector<float>& distance_m, float middle_m) {
  distance_m.push_back(middle_m);
  distance_m.push_back(std::nextafter(middle_m, kInfinity));
  if (middle_m > 0.0F) distance_m.push_back(std::nextafter(middle_m, 0.0F));
}

TEST(MeasuredRange, IsInvalidNearerAndNoReturnFarther) {
  const RangeLimits limits{0.5, 4.0};
  std::vector<float> range_m = {0.0F, 0.49999F, 0.5F, 1.23456F, 4.0F, 4.0001F, kInfinity};
  measure_ranges(limits, range_m);
  EXPECT_TRUE(std::isnan(range_m[0]));
  EXPECT_TRUE(std::isnan(range_m[1]));
  EXPECT_EQ(range_m[2], 0.5F);
  EXPECT_EQ(range_m[3], 1.2346F);
  EXPECT_EQ(range_m[4], 4.0F);
  EXPECT_EQ(range_m[5], kInfinity);
  EXPECT_EQ(range_m[6], kInfinity);
}

TEST(MeasuredRange, OfManyIsThatOfEach) {
  RandomStream random = random_stream(7);
  std::vector<float> distance_m;
  for (int i = 0; i < 1'000'000; ++i) {
    distance_m.push_back(static_cast<float>(std::exp2(40.0 * random.uniform() - 20.0)));
  }
  for (const RangeLimits& limits : kLimits) {
    EXPECT_EQ(differing(distance_m, limits), 0) << limits.min_m << " to " << limits.max_m;
  }
}

// Where rounding turns: in the middle between two steps of 0.1 mm; and the steps themselves.
TEST(MeasuredRange, OfManyIsThatOfEachAtEveryStep) {
  std::vector<float> distance_m;
  for (int half_steps = 0; half_steps < 600'000; ++half_steps) {
    push_with_neighbours(distance_m, static_cast<float>(half_steps * 0.5e-4));
  }
  EXPECT_EQ(differing(distance_m, {0.05, 30.0}), 0);
  EXPECT_EQ(differing(distance_m, {0.0, 2e5}), 0);
}

TEST(MeasuredRange, OfManyIsThatOfEachAtTheLimits) {
  for (const RangeLimits& limits : kLimits) {
    std::vector<float> distance_m = {0.0F,
                                     std::numeric_limits<float>::denorm_min(),
                                     std::numeric_limits<float>::min(),
                                     std::numeric_limits<float>::max(),
                                     kInfinity,
                                     std::numeric_limits<float>::quiet_NaN()};
    push_with_neighbours(distance_m, static_cast<float>(limits.min_m));
    push_with_neighbours(distance_m, static_cast<float>(limits.max_m));
    EXPECT_EQ(differing(distance_m, limits), 0) << limits.min_m << " to " << limits.max_m;
  }
}

TEST(MeasuredRange, OfAnyNumberOfDistances) {
  for (std::size_t count = 0; count < 70; ++count) {
    std::vector<float> distance_m(count);
    for (std::size_t i = 0; i < count; ++i) distance_m[i] = 0.03F * static_cast<float>(i);
    EXPECT_EQ(differing(distance_m, {0.05, 1.5}), 0) << count;
  }
}

}  // namespace
}  // namespace nextview
