#include "viewer/block_history.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace nextview {
namespace {

using Bytes = std::vector<std::uint8_t>;

TEST(SpillFile, GivesBackWhatItWasGiven) {
  SpillFile file;
  const Spilled a = file.append(Bytes{1, 2, 3});
  const Spilled nothing = file.append(Bytes{});
  const Spilled b = file.append(Bytes{4});
  Bytes out = {9};
  file.read(b, out);
  file.read(nothing, out);
  file.read(a, out);
  EXPECT_EQ(out, (Bytes{9, 4, 1, 2, 3}));
  EXPECT_EQ(file.size(), 4U);
  EXPECT_THROW(file.read({3, 2}, out), std::runtime_error) << "beyond its end";
}

TEST(BlockHistory, HoldsWhatABlockWasAfterEveryView) {
  SpillFile file;
  BlockHistory history(file);
  history.add(2, 70, {1, -2, 3}, Bytes{1, 1});
  history.add(4, 70, {1, -2, 3}, Bytes{1, 1});  // the same again
  history.add(5, 70, {1, -2, 3}, Bytes{});      // empty from here on
  history.add(5, 71, {0, 0, 0}, Bytes{});       // never held anything
  ASSERT_EQ(history.blocks(), 1U);
  EXPECT_EQ(history.coordinate(0), (std::array<std::int16_t, 3>{1, -2, 3}));
  EXPECT_EQ(history.since(0, 1), 0);
  EXPECT_EQ(history.since(0, 2), 2);
  EXPECT_EQ(history.since(0, 4), 2);
  EXPECT_EQ(history.since(0, 5), 5);
  EXPECT_EQ(history.bytes(0, 4), 2U);
  EXPECT_EQ(history.bytes(0, 5), 0U);
}

TEST(BlockHistory, OfTwoThousandViewsIsBoundedAndRight) {
  constexpr int kViews = 2000;
  constexpr int kChangesAView = 200;
  constexpr std::uint32_t kBlocks = 3000;
  SpillFile file;
  BlockHistory history(file);
  std::mt19937 dice(1);
  std::map<std::uint32_t, std::map<int, Bytes>> plain;  // by block and view
  for (int view = 1; view <= kViews; ++view) {
    for (int change = 0; change < kChangesAView; ++change) {
      const auto block = static_cast<std::uint32_t>(dice() % kBlocks);
      const Bytes surface(dice() % 512, static_cast<std::uint8_t>(dice()));
      history.add(view, block, {static_cast<std::int16_t>(block), 0, 0}, surface);
      // Kept of some blocks only: the plain twin holds all in memory.
      if (block % 20 == 0) plain[block][view] = surface;
    }
  }
  // 32 bytes a changed block, and something for each block.
  EXPECT_LT(history.memory_bytes(), 32U * kViews * kChangesAView + 150U * kBlocks);
  int compared = 0;
  for (std::size_t place = 0; place < history.blocks(); ++place) {
    const auto block = static_cast<std::uint32_t>(history.coordinate(place)[0]);
    if (!plain.contains(block)) continue;
    for (int view = 1; view <= kViews; view += 61) {
      const auto after = plain[block].upper_bound(view);
      const Bytes expected = after == plain[block].begin() ? Bytes{} : std::prev(after)->second;
      Bytes held;
      history.read(place, view, held);
      ASSERT_EQ(held, expected) << "block " << block << " after view " << view;
      ++compared;
    }
  }
  EXPECT_GT(compared, 4000);
}

}  // namespace
}  // namespace nextview
