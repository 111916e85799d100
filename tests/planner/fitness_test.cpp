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
  const Fitness f = fitness(counts);
  EXPECT_DOUBLE_EQ(f.share_occupied, 0.4);
  EXPECT_DOUBLE_EQ(f.share_occlusion_plane, 0.3);
  EXPECT_DOUBLE_EQ(f.share_unseen, 0.3);
  EXPECT_DOUBLE_EQ(f.share_open, 0.5);
  EXPECT_NEAR(f.value, 1.04, 1e-12);
}

TEST(Fitness, IsZeroWhereAllRaysAreOpen) {
  ViewCounts counts;
  counts.open = 1920;
  const Fitness f = fitness(counts, {}, {1.0, 1.0, 1.0});
  EXPECT_EQ(f.value, 0.0);
  EXPECT_EQ(f.share_open, 1.0);
  EXPECT_EQ(f.share_occupied + f.share_occlusion_plane + f.share_unseen, 0.0);
}

// A bare wall is looked at (f_area = 0.5), 2 m straight ahead of where the robot stands; half its
// voxels would improve by 0.4.
class FitnessOfAWall : public ::testing::Test {
 protected:
  FitnessOfAWall() {
    counts.occupied = 10;
    counts.occupied_voxels = 4;
    counts.improved_voxels = 2;
    counts.improvement = kUnit * 8 / 10;
    for (int voxel = 0; voxel < 4; ++voxel) counts.normals.add({0, 0, 16384});
  }

  ViewCounts counts;
  Travel travel{.length_m = kNavigationHalf_m};
};

TEST_F(FitnessOfAWall, IsTheProductOfTheFactorsThatCount) {
  FactorWeights weights = {};
  weights[kQualityFactor] = 1.0;
  weights[kNavigationFactor] = 3.0;
  const Fitness f = fitness(counts, travel, weights);
  EXPECT_NEAR(f.factors[kQualityFactor], 0.2, 1e-12);
  EXPECT_EQ(f.factors[kNavigationFactor], 0.5);
  EXPECT_NEAR(f.value, 0.5 * (1.0 + 0.2) * (1.0 + 3.0 * 0.5), 1e-12);
  weights[kStructureFactor] = 10.0;
  EXPECT_EQ(fitness(counts, travel, weights).factors[kStructureFactor], 0.0);
  EXPECT_EQ(fitness(counts, travel, weights).value, f.value) << "a wall has no structure";
}

TEST_F(FitnessOfAWall, WithoutFactorsIsThatOfTheAreas) {
  EXPECT_NEAR(fitness(counts).value, 0.5, 1e-12);
  EXPECT_EQ(fitness(counts).value, fitness(counts, travel, {}).value);
  EXPECT_EQ(fitness(counts, travel, {}).factors, FactorValues{}) << "none is worked out";
}

// What is in a message and in a table finds its factor by name.
TEST(Factors, AreThreeAndOfTwoKinds) {
  ASSERT_EQ(kFactors.size(), 3U);
  EXPECT_EQ(kFactors[kQualityFactor].name, "quality");
  EXPECT_EQ(kFactors[kStructureFactor].name, "structure");
  EXPECT_EQ(kFactors[kNavigationFactor].name, "navigation");
  for (const Factor& factor : kFactors) {
    EXPECT_NE(factor.of_surfaces == nullptr, factor.of_travel == nullptr) << factor.name;
    EXPECT_EQ(factor.default_weight, 0.0) << factor.name << " is off unless it is asked for";
  }
  EXPECT_EQ(default_weights(), FactorWeights{});
}

TEST(Factors, SayWhatTheyNeed) {
  for (std::size_t i = 0; i < kFactors.size(); ++i) {
    FactorWeights weights = {};
    EXPECT_FALSE(ask_for_surfaces(weights) || ask_for_travel(weights));
    weights[i] = 0.5;
    EXPECT_EQ(ask_for_surfaces(weights), i != kNavigationFactor);
    EXPECT_EQ(ask_for_travel(weights), i == kNavigationFactor);
  }
}

}  // namespace
}  // namespace nextview
