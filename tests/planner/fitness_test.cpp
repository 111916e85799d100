#include "planner/fitness.h"

#include <gtest/gtest.h>

#include "mapper/voxel_map.h"

namespace nextview {
namespace {

constexpr std::int64_t kUnit = SurfaceVoxel::kQualityUnit;

TEST(AreaFitness, HasThePapersValues) {
  EXPECT_NEAR(area_fitness(0.4, 0.3, 0.3), 1.04, 1e-12);
  EXPECT_NEAR(area_fitness(1.0, 0.0, 0.0), 0.5, 1e-12);
  EXPECT_EQ(area_fitness(0.0, 0.5, 0.5), 0.0);
  EXPECT_NEAR(area_fitness(0.97, 0.03, 0.0), 0.496, 5e-4);
  EXPECT_NEAR(area_fitness(0.97, 0.0, 0.03), 0.496, 5e-4);
}

TEST(AreaFitness, IsLargestAtTwoFifthsWithTheUnknownInBalance) {
  int tried = 0;
  for (int i = 0; i <= 100; ++i) {
    for (int j = 0; i + j <= 100; ++j) {
      const double a_ov = i / 100.0;
      const double a_op = j / 100.0;
      EXPECT_LE(area_fitness(a_ov, a_op, 1.0 - a_ov - a_op), 1.04 + 1e-12);
      ++tried;
    }
  }
  EXPECT_EQ(tried, 5151);
}

TEST(AreaFitness, HasALocalMinimumAtAViewOfNothingNew) {
  EXPECT_GT(area_fitness(0.9, 0.05, 0.05), 0.5);
}

TEST(Fitness, SharesAreOfTheRaysThatMeetSomething) {
  ViewCounts counts;
  counts.occupied = 40;
  counts.occlusion_plane = 30;
  counts.unseen = 30;
  counts.open = 100;
  const Fitness f = fitness(counts, {});
  EXPECT_DOUBLE_EQ(f.share_occupied, 0.4);
  EXPECT_DOUBLE_EQ(f.share_occlusion_plane, 0.3);
  EXPECT_DOUBLE_EQ(f.share_unseen, 0.3);
  EXPECT_DOUBLE_EQ(f.share_open, 0.5);
  EXPECT_NEAR(f.value, 1.04, 1e-12);
}

TEST(Fitness, IsZeroWhereAllRaysAreOpen) {
  ViewCounts counts;
  counts.open = 1920;
  const Fitness f = fitness(counts, {1.0});
  EXPECT_EQ(f.value, 0.0);
  EXPECT_EQ(f.share_open, 1.0);
  EXPECT_EQ(f.share_occupied + f.share_occlusion_plane + f.share_unseen, 0.0);
}

// Four voxels are met and two of them improve, by 0.6 and 0.2: half of them, by 0.4 in the mean.
TEST(Fitness, QualityIsTheShareThatImprovesTimesTheMeanImprovement) {
  ViewCounts counts;
  counts.occupied = 10;
  counts.occupied_voxels = 4;
  counts.improved_voxels = 2;
  counts.improvement = kUnit * 6 / 10 + kUnit * 2 / 10;
  EXPECT_NEAR(quality_factor(counts), 0.2, 1e-12);
  EXPECT_NEAR(fitness(counts, {1.0}).value, 0.5 * 1.2, 1e-12);
  EXPECT_NEAR(fitness(counts, {1.0}).factors[kQualityFactor], 0.2, 1e-12);
  EXPECT_NEAR(fitness(counts, {}).value, 0.5, 1e-12);
  EXPECT_EQ(fitness(counts, {}).factors[kQualityFactor], 0.0);
}

TEST(Fitness, QualityIsZeroWhereNothingImproves) {
  ViewCounts counts;
  counts.occupied = 10;
  counts.occupied_voxels = 4;
  EXPECT_EQ(quality_factor(counts), 0.0);
  EXPECT_EQ(quality_factor(ViewCounts{}), 0.0);
}

}  // namespace
}  // namespace nextview
