#include "planner/quality_factor.h"

#include <gtest/gtest.h>

#include "mapper/voxel_map.h"

namespace nextview {
namespace {

constexpr std::int64_t kUnit = SurfaceVoxel::kQualityUnit;

// Four voxels are met and two of them improve, by 0.6 and 0.2: half of them, by 0.4 in the mean.
TEST(QualityFactor, IsTheShareThatImprovesTimesTheMeanImprovement) {
  ViewCounts counts;
  counts.occupied_voxels = 4;
  counts.improved_voxels = 2;
  counts.improvement = kUnit * 6 / 10 + kUnit * 2 / 10;
  EXPECT_NEAR(quality_factor(counts), 0.2, 1e-12);
}

TEST(QualityFactor, IsOneWhenAllIsSeenAsWellAsCanBeForTheFirstTime) {
  ViewCounts counts;
  counts.occupied_voxels = counts.improved_voxels = 7;
  counts.improvement = 7 * kUnit;
  EXPECT_EQ(quality_factor(counts), 1.0);
}

TEST(QualityFactor, IsZeroWhereNothingImproves) {
  ViewCounts counts;
  counts.occupied_voxels = 4;
  EXPECT_EQ(quality_factor(counts), 0.0);
  EXPECT_EQ(quality_factor(ViewCounts{}), 0.0);
}

}  // namespace
}  // namespace nextview
