// The runs of a row against a plain loop over its pixels, on every instruction set.
#include "mapper/pixel_runs.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <iostream>

#include "tests/mapper/analytic_world.h"

namespace nextview {
namespace {

using Column = std::vector<std::int32_t>;

// A row with junk before its first pixel and beyond its last.
struct RandomRow {
  RandomRow(int row_columns, RandomStream& random) : columns(row_columns) {
    const auto size = static_cast<std::size_t>(1 + columns + NormalRow::kPadding);
    for (Column& part : parts) part.resize(size);
    for (Column* part : {&normals.x, &normals.y, &normals.z, &normals.quality}) part->resize(size);
    const std::uint32_t one_in = 1 + random.below(20);
    for (std::size_t i = 0; i < size; ++i) {
      for (Column& part : parts) {
        const bool changes = i == 0 || random.below(one_in) == 0;
        part[i] = changes ? uniform_int(random, -2, 2) : part[i - 1];
      }
      if (random.below(4) == 0) continue;  // without normal
      constexpr int kUnit = SurfaceVoxel::kNormalUnit;
      normals.x[i] = uniform_int(random, -kUnit, kUnit);
      normals.y[i] = random.below(4) == 0 ? 0 : uniform_int(random, -kUnit, kUnit);
      normals.z[i] = random.below(4) == 0 ? 0 : uniform_int(random, -kUnit, kUnit);
      normals.quality[i] = uniform_int(random, 0, SurfaceVoxel::kQualityUnit);
    }
  }
  RowEnds ends() const {
    return {{parts[0].data() + 1, parts[1].data() + 1, parts[2].data() + 1},
            parts[3].data() + 1,
            parts[4].data() + 1};
  }
  // In the first so many parts.
  bool same(int u, const RandomRow& other, int other_u, std::size_t count) const {
    for (std::size_t n = 0; n < count; ++n) {
      const auto i = static_cast<std::size_t>(u + 1), j = static_cast<std::size_t>(other_u + 1);
      if (parts[n][i] != other.parts[n][j]) return false;
    }
    return true;
  }

  int columns;
  std::array<Column, 5> parts;  // voxel, kind and limit, from column -1 on
  NormalRow normals;
};

std::vector<PixelRun> plain_runs(const RandomRow& row) {
  std::vector<PixelRun> runs;
  for (int u = 0; u < row.columns; ++u) {
    if (u % 65536 == 0 || !row.same(u, row, u - 1, 4)) runs.push_back({u, u, {0, 0, 0, 0}, 0});
    PixelRun& run = runs.back();
    const auto i = static_cast<std::size_t>(u);
    ++run.end;
    run.normal_sum[0] += row.normals.x[i];
    run.normal_sum[1] += row.normals.y[i];
    run.normal_sum[2] += row.normals.z[i];
    run.normal_sum[3] += row.normals.x[i] != 0 || row.normals.y[i] != 0 || row.normals.z[i] != 0;
    run.quality = std::max(run.quality, row.normals.quality[i]);
  }
  return runs;
}

void expect_equal(std::span<const PixelRun> found, const std::vector<PixelRun>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t n = 0; n < expected.size(); ++n) {
    ASSERT_EQ(found[n].begin, expected[n].begin);
    ASSERT_EQ(found[n].end, expected[n].end);
    for (std::size_t i = 0; i < 4; ++i) {
      ASSERT_EQ(found[n].normal_sum[i], expected[n].normal_sum[i]) << "run " << n << ", sum " << i;
    }
    ASSERT_EQ(found[n].quality, expected[n].quality);
  }
}

// Calls a test once for every instruction set this processor has.
template <typename Test>
void on_every_instruction_set(Test test) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    test();
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

TEST(PixelRuns, EqualAPlainLoopOverThePixels) {
  std::size_t runs = 0;
  on_every_instruction_set([&] {
    PixelRuns pixel_runs;  // one object serves many rows
    for (int n = 0; n < 500; ++n) {
      SCOPED_TRACE("case " + std::to_string(n));
      RandomStream random(n, 1, 1, RandomPurpose::RangeNoise);
      const RandomRow row(uniform_int(random, 2, 200), random);
      const auto expected = plain_runs(row);
      expect_equal(pixel_runs.find(row.columns, row.ends(), row.normals), expected);
      if (testing::Test::HasFatalFailure()) return;
      runs += expected.size();
    }
  });
  EXPECT_GT(runs, 10'000u);
  std::cout << runs << " runs\n";
}

TEST(PixelRuns, OtherLinesAreThoseNeitherToTheLeftNorAbove) {
  std::size_t others = 0, same = 0;
  on_every_instruction_set([&] {
    PixelRuns pixel_runs;
    for (int n = 0; n < 500; ++n) {
      SCOPED_TRACE("case " + std::to_string(n));
      RandomStream random(n, 1, 2, RandomPurpose::RangeNoise);
      const int columns = uniform_int(random, 2, 200);
      const RandomRow above(columns, random);
      RandomRow row = above;
      for (Column& part : row.parts) {
        for (std::int32_t& value : part) {
          if (random.below(8) == 0) value = uniform_int(random, -2, 2);
        }
      }
      std::vector<std::int32_t> expected;
      for (int u = 0; u < columns; ++u) {
        const bool as_left = u > 0 && row.same(u, row, u - 1, 5);
        if (!as_left && !row.same(u, above, u, 5)) expected.push_back(u);
      }
      const auto found = pixel_runs.find_other_lines(columns, row.ends(), above.ends());
      ASSERT_TRUE(std::ranges::equal(found, expected));
      others += expected.size();
      same += static_cast<std::size_t>(columns) - expected.size();
    }
  });
  EXPECT_GT(others, 10'000u);
  EXPECT_GT(same, 10'000u);
}

// The largest sums of the longest runs still fit.
TEST(PixelRuns, NoRunIsSoLongThatItsSumsOverflow) {
  on_every_instruction_set([] {
    RandomStream random(1, 1, 1, RandomPurpose::RangeNoise);
    RandomRow row(140'000, random);
    for (Column& part : row.parts) std::fill(part.begin(), part.end(), 7);
    std::fill(row.normals.x.begin(), row.normals.x.end(), SurfaceVoxel::kNormalUnit);
    std::fill(row.normals.y.begin(), row.normals.y.end(), -SurfaceVoxel::kNormalUnit);
    PixelRuns pixel_runs;
    const auto found = pixel_runs.find(row.columns, row.ends(), row.normals);
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(found[0].normal_sum[0], 65536 * SurfaceVoxel::kNormalUnit);
    expect_equal(found, plain_runs(row));
  });
}

}  // namespace
}  // namespace nextview
