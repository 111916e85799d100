#include <gtest/gtest.h>

#include <algorithm>

#include "scoring/cover_bound.h"
#include "scoring/greedy_cover.h"
#include "scoring/view_bound.h"
#include "sensor/random_stream.h"

namespace nextview {
namespace {

CoverSets sets_of(std::vector<std::uint32_t> weights,
                  const std::vector<std::vector<std::uint32_t>>& poses) {
  CoverSets sets;
  sets.weights = std::move(weights);
  for (const auto& pose : poses) sets.add_pose(pose);
  return sets;
}

TEST(CoverSets, KeepWhatTheyWereGiven) {
  CoverSets sets;
  std::vector<std::vector<std::uint32_t>> poses = {
      {}, {0}, {127}, {0, 127, 128, 255, 16383, 16384, 2097152, 268435456, 4294967295}};
  RandomStream random(7, 0, 0, RandomPurpose::InitialSimplex);
  while (poses.size() < 20'000) {  // more than fit into one part
    std::vector<std::uint32_t>& covered = poses.emplace_back();
    std::uint32_t voxel = 0;
    for (std::uint64_t left = random.below(6); left > 0; --left) {
      voxel += 1 + static_cast<std::uint32_t>(random.below(40'000));
      covered.push_back(voxel);
    }
  }
  for (const auto& covered : poses) sets.add_pose(covered);
  ASSERT_EQ(sets.poses(), poses.size());
  for (std::size_t pose = 0; pose < poses.size(); ++pose) {
    ASSERT_EQ(sets.covered_by(pose), poses[pose]) << pose;
  }
}

const std::size_t kNone[] = {0};
const std::span<const std::size_t> kNoFirst(kNone, 0);

TEST(GreedyCover, TakesWhatAddsMost) {
  const CoverSets sets = sets_of({1, 1, 1, 5}, {{0, 1}, {1, 2}, {3}, {0, 1, 2}});
  EXPECT_EQ(greedy_cover(sets, kNoFirst, 1.0), (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(greedy_cover(sets, kNoFirst, 0.6), (std::vector<std::size_t>{2}));
  const std::size_t first[] = {0};
  EXPECT_EQ(greedy_cover(sets, first, 1.0), (std::vector<std::size_t>{0, 2, 1}));
  EXPECT_EQ(share_covered(sets, first), 0.25);
}

TEST(GreedyCover, EndsWhenNothingIsAdded) {
  const CoverSets sets = sets_of({1, 1}, {{0}, {0}});
  EXPECT_EQ(greedy_cover(sets, kNoFirst, 1.0), (std::vector<std::size_t>{0}));
}

TEST(FewestPoses, IsOneAndAHalfOnATriangle) {
  // Every pose covers two of three voxels: half of each pose covers all, one and a half poses.
  const CoverSets sets = sets_of({1, 1, 1}, {{0, 1}, {1, 2}, {2, 0}});
  EXPECT_NEAR(fewest_poses(sets, kNoFirst, 1.0), 1.5, 1e-6);
  EXPECT_NEAR(fewest_poses(sets, kNoFirst, 2.0 / 3.0), 1.0, 1e-6);
  const std::size_t first[] = {0};
  EXPECT_NEAR(fewest_poses(sets, first, 1.0), 1.0, 1e-6);
  EXPECT_EQ(fewest_poses(sets, first, 0.5), 0.0);
}

TEST(FewestPoses, TakesTheBestPartWhereSomeMayBeLeft) {
  // Three parts of 4, 3 and 1: for three quarters of 8 the first pose and two thirds of the second.
  const CoverSets sets = sets_of({4, 3, 1}, {{0}, {1}, {2}});
  EXPECT_NEAR(fewest_poses(sets, kNoFirst, 0.75), 1.0 + 2.0 / 3.0, 1e-6);
}

TEST(FewestPoses, IsNearlyTheSameByPrices) {
  const CoverBoundParameters by_prices{.most_voxels = 0};
  const CoverSets triangle = sets_of({1, 1, 1}, {{0, 1}, {1, 2}, {2, 0}});
  EXPECT_NEAR(fewest_poses(triangle, kNoFirst, 1.0, by_prices), 1.5, 0.01);
  const CoverSets parts = sets_of({4, 3, 1}, {{0}, {1}, {2}});
  EXPECT_NEAR(fewest_poses(parts, kNoFirst, 0.75, by_prices), 1.0 + 2.0 / 3.0, 0.05);
}

TEST(FewestPoses, RefusesAShareThatPosesDoNotReach) {
  EXPECT_THROW(fewest_poses(sets_of({1, 1}, {{0}}), kNoFirst, 1.0), std::invalid_argument);
}

/// The fewest poses, by trying all choices.
std::size_t fewest_by_trying(const CoverSets& sets, double share) {
  std::size_t fewest = sets.poses();
  for (std::uint32_t choice = 0; choice < 1U << sets.poses(); ++choice) {
    std::vector<std::size_t> poses;
    for (std::size_t pose = 0; pose < sets.poses(); ++pose) {
      if ((choice >> pose & 1U) != 0) poses.push_back(pose);
    }
    if (poses.size() < fewest && share_covered(sets, poses) >= share) fewest = poses.size();
  }
  return fewest;
}

TEST(FewestPoses, IsNeverAboveTheFewestThereAreAndTheGreedyNeverBelow) {
  int tight = 0;
  int close = 0;
  int cases = 0;
  for (int world = 0; world < 200; ++world) {
    RandomStream random(world, 0, 0, RandomPurpose::InitialSimplex);
    CoverSets sets;
    for (int voxel = 0; voxel < 20; ++voxel) {
      sets.weights.push_back(1 + static_cast<std::uint32_t>(random.below(9)));
    }
    for (int pose = 0; pose < 10; ++pose) {
      std::vector<std::uint32_t> covered;
      for (std::uint32_t voxel = 0; voxel < 20; ++voxel) {
        if (random.below(3) == 0) covered.push_back(voxel);
      }
      sets.add_pose(covered);
    }
    const double share = world % 2 == 0 ? 0.9 : 0.7;
    const std::vector<std::size_t> greedy = greedy_cover(sets, kNoFirst, share);
    if (share_covered(sets, greedy) < share) continue;
    ++cases;
    const double bound =
        fewest_poses(sets, kNoFirst, share, {.most_rounds = 80, .poses_a_round = 2, .alike = 3});
    const std::size_t fewest = fewest_by_trying(sets, share);
    EXPECT_LE(bound, static_cast<double>(fewest) + 1e-6) << world;
    EXPECT_GE(greedy.size(), fewest) << world;
    if (std::ceil(bound - 1e-6) == static_cast<double>(fewest)) ++tight;
    const double by_prices = fewest_poses(sets, kNoFirst, share, {.most_voxels = 0});
    EXPECT_LE(by_prices, static_cast<double>(fewest) + 1e-6) << world;
    if (by_prices > 0.97 * bound) ++close;
  }
  EXPECT_GT(cases, 100);
  EXPECT_GT(tight, cases / 2) << "of " << cases;
  EXPECT_GT(close, cases * 4 / 5) << "of " << cases;
}

TEST(DistanceToCover, IsThatOfTheFarthestVoxelThatIsNeeded) {
  const CoverSets sets = sets_of({5, 3, 2}, {{0, 1, 2}});
  const std::vector<double> nearest_m = {7.0, 1.0, 3.0};
  EXPECT_EQ(distance_to_cover_m(sets, nearest_m, 0.3), 1.0);
  EXPECT_EQ(distance_to_cover_m(sets, nearest_m, 0.5), 3.0);
  EXPECT_EQ(distance_to_cover_m(sets, nearest_m, 0.6), 7.0);
}

}  // namespace
}  // namespace nextview
