// Numbered keys against std::map, over many keys that come again.
#include "mapper/key_numbers.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/mapper/analytic_world.h"

namespace nextview {
namespace {

TEST(KeyNumbers, NumberKeysInTheOrderInWhichTheyFirstCome) {
  KeyNumbers numbers;
  numbers.clear(0);
  EXPECT_EQ(numbers.number_of(7), 0u);
  EXPECT_EQ(numbers.number_of(~std::uint64_t{0}), 1u);
  EXPECT_EQ(numbers.number_of(7), 0u);
  EXPECT_EQ(numbers.number_of(0), 2u);
  EXPECT_EQ(numbers.size(), 3u);
  numbers.clear(0);
  EXPECT_EQ(numbers.size(), 0u);
  EXPECT_EQ(numbers.number_of(0), 0u);
}

TEST(KeyNumbers, EqualAMapOverKeysThatComeAgainAndCollide) {
  KeyNumbers numbers;
  std::int64_t repeats = 0;
  for (int n = 0; n < 200; ++n) {  // one object serves many sets of keys
    RandomStream random(n, 1, 1, RandomPurpose::RangeNoise);
    numbers.clear(random.below(5000));
    std::map<std::uint64_t, std::uint32_t> reference;
    const std::uint32_t different = 1 + random.below(8000);
    // Few bits at either end of the key, so that many hash alike.
    const int shift = uniform_int(random, 0, 50);
    for (int i = 0; i < 8000; ++i) {
      const std::uint64_t key = std::uint64_t{random.below(different)} << shift;
      const auto [entry, is_new] =
          reference.try_emplace(key, static_cast<std::uint32_t>(reference.size()));
      repeats += !is_new;
      ASSERT_EQ(numbers.number_of(key), entry->second);
    }
    ASSERT_EQ(numbers.size(), reference.size());
  }
  EXPECT_GT(repeats, 100'000);
}

}  // namespace
}  // namespace nextview
