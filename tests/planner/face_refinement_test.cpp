#include "planner/face_refinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "planner/prediction/fast_view_predictor.h"
#include "planner/prediction/panorama_view_predictor.h"
#include "planner/prediction/selective_view_predictor.h"
#include "planner/view_evaluator.h"
#include "tests/planner/random_known_room.h"

namespace nextview {
namespace {

// Of a view whose rays meet these shares.
Fitness with_shares(double occupied, double plane, double unseen) {
  Fitness fitness;
  fitness.share_occupied = occupied;
  fitness.share_occlusion_plane = plane;
  fitness.share_unseen = unseen;
  fitness.value = area_fitness(occupied, plane, unseen);
  return fitness;
}

const Fitness kNothingNew = with_shares(1.0, 0.0, 0.0);  // 0.5
const Fitness kBest = with_shares(0.4, 0.3, 0.3);        // 1.04

TEST(HopeWithin, IsTheBestThatSharesMayBecome) {
  // Nothing is better than the best, and no factor counts.
  EXPECT_NEAR(hope_within(kBest, 0, {}), 1.04, 1e-12);
  // At 80 faces a_ov may become 0.78 from 1, and the other two be equal:
  // ((5 x 0.78 - 10.5) x 0.78 + 6) x 0.78 = 0.66456.
  EXPECT_NEAR(hope_within(kNothingNew, 1, {}), 0.66456, 1e-12);
  // From a_ov = 0.1, a_op - a_us = 0.9 there are 0.32 and 0.9 - 1.5 x 0.22 = 0.57:
  // ((1.6 - 10.5) x 0.32 + 6) x 0.32 = 1.00864, times 1 - 0.285.
  EXPECT_NEAR(hope_within(with_shares(0.1, 0.9, 0.0), 1, {}), 1.00864 * 0.715, 1e-12);
  // From the third subdivision on each changes half as much as the one before.
  EXPECT_NEAR(hope_within(kNothingNew, 2, {}), area_fitness(0.85, 0.0, 0.0), 1e-12);
  EXPECT_NEAR(hope_within(kNothingNew, 3, {}), area_fitness(0.925, 0.0, 0.0), 1e-12);
  EXPECT_NEAR(hope_within(kNothingNew, 4, {}), area_fitness(0.9625, 0.0, 0.0), 1e-12);
}

TEST(HopeWithin, IsMoreWhereFactorsMayRise) {
  FactorWeights weights = {};
  weights[kQualityFactor] = 1.0;
  Fitness face = kBest;
  face.factors[kQualityFactor] = 0.3;
  face.value *= 1.3;
  // The shares are the best there are; at 80 faces quality may become 0.6.
  EXPECT_NEAR(hope_within(face, 1, weights), 1.04 * 1.6, 1e-12);
  // It has no more than 1, and the way there is the same for all orientations.
  face.factors[kQualityFactor] = 0.95;
  face.factors[kNavigationFactor] = 0.5;
  face.value = 1.04 * 1.95 * 1.25;
  weights[kNavigationFactor] = 0.5;
  EXPECT_NEAR(hope_within(face, 1, weights), 1.04 * 2.0 * 1.25, 1e-12);
  // Both: the shares alone would give 0.66456 x 1.5, the factor alone 0.5 x 1.8.
  face = kNothingNew;
  face.factors[kQualityFactor] = 0.5;
  face.value = 0.75;
  weights[kNavigationFactor] = 0.0;
  EXPECT_NEAR(hope_within(face, 1, weights),
              0.75 + std::hypot(0.66456 * 1.5 - 0.75, 0.5 * 1.8 - 0.75), 1e-12);
}

// Faces have a fitness of nothing new but for those that are named, and what is tried is counted.
struct NamedFaces {
  FaceRefinement refinement;
  std::map<std::size_t, Fitness> named = {};
  std::vector<std::size_t> may_not = {};
  std::vector<std::size_t> tried = {};

  BestView best() {
    return refinement.best_view(
        [this](std::span<const std::size_t> which, std::span<Fitness> values) {
          for (std::size_t i = 0; i < which.size(); ++i) {
            tried.push_back(which[i]);
            const auto found = named.find(which[i]);
            values[i] = found == named.end() ? kNothingNew : found->second;
          }
        },
        [this](std::size_t orientation) { return std::ranges::count(may_not, orientation) == 0; },
        {});
  }
};

TEST(FaceRefinement, GoesStraightToTheBestOfAllThereIs) {
  // Face 7, of whose four parts the second, of whose four parts the third.
  NamedFaces faces{FaceRefinement(2)};
  faces.named = {{7, kBest}, {20 + 29, kBest}, {100 + 118, kBest}};
  const BestView best = faces.best();
  EXPECT_TRUE(best.any);
  EXPECT_EQ(best.orientation, 100u + 118u);
  EXPECT_EQ(best.fitness.value, kBest.value);
  std::vector<std::size_t> expected(20);
  for (std::size_t i = 0; i < 20; ++i) expected[i] = i;
  for (const std::size_t part : {48u, 49u, 50u, 51u, 216u, 217u, 218u, 219u})
    expected.push_back(part);
  EXPECT_EQ(faces.tried, expected);
}

TEST(FaceRefinement, TriesAllAsLongAsThereIsHopeInAll) {
  NamedFaces faces{FaceRefinement(2)};
  const BestView best = faces.best();
  EXPECT_EQ(best.orientation, 100u) << "ties go to the lowest";
  EXPECT_EQ(faces.tried.size(), 20u + 80u + 320u);
}

TEST(FaceRefinement, LeavesWhatIsHopeless) {
  // Where all is unseen, a_ov = 0 and |a_op - a_us| = 1, the 20 faces hope for a_ov = 0.4 and
  // 1 - 1.5 x 0.5 = 0.25, which is 1.04 x 0.875 = 0.91; the 80 for a_ov = 0.22 and 0.67, 0.58.
  NamedFaces faces{FaceRefinement(2)};
  for (std::size_t i = 0; i < 420; ++i) faces.named[i] = with_shares(0.0, 0.0, 1.0);
  const Fitness good = with_shares(0.4, 0.45, 0.15);  // 1.04 x 0.85 = 0.884
  faces.named[3] = faces.named[20 + 12] = faces.named[100 + 48] = good;
  EXPECT_EQ(faces.best().orientation, 100u + 48u);
  // So all 20 are divided, and of the 80 that one part.
  EXPECT_EQ(faces.tried.size(), 20u + 80u + 4u);
}

TEST(FaceRefinement, WhatMayNotBeChosenIsNot) {
  NamedFaces faces{FaceRefinement(1)};
  faces.named = {{7, kBest}, {20 + 29, kBest}, {20 + 31, with_shares(0.5, 0.25, 0.25)}};
  faces.may_not = {20 + 29};
  EXPECT_EQ(faces.best().orientation, 20u + 31u);
  for (std::size_t i = 20; i < 100; ++i) faces.may_not.push_back(i);
  EXPECT_FALSE(faces.best().any);
}

TEST(FaceRefinement, WithoutSubdivisionIsTheTwentyFaces) {
  NamedFaces faces{FaceRefinement(0)};
  faces.named = {{11, kBest}, {12, kBest}};
  EXPECT_EQ(faces.best().orientation, 11u);
  EXPECT_EQ(faces.tried.size(), 20u);
}

TEST(FaceRefinement, HasTheOrientationsOfAllLevels) {
  for (int subdivisions = 0; subdivisions <= 4; ++subdivisions) {
    const FaceRefinement refinement(subdivisions);
    const auto finest = icosahedron_orientations(subdivisions);
    ASSERT_EQ(refinement.finest().size(), finest.size());
    for (std::size_t i = 0; i < finest.size(); ++i) {
      EXPECT_EQ(refinement.finest()[i].direction, finest[i].direction);
    }
  }
  EXPECT_EQ(FaceRefinement::first_of(0), 0u);
  EXPECT_EQ(FaceRefinement::first_of(1), 20u);
  EXPECT_EQ(FaceRefinement::first_of(3), 420u);
  EXPECT_EQ(FaceRefinement::first_of(6), 27300u);
  EXPECT_THROW(FaceRefinement(-1), std::invalid_argument);
  EXPECT_THROW(FaceRefinement(7), std::invalid_argument);
}

// What refinement finds beside all orientations of its last level, over random states of maps.
struct Comparison {
  int states = 0;
  int same = 0;
  double evaluations = 0.0;  // of all there would be
  double largest_loss = 0.0;
};

template <class Refined, class Exhaustive>
Comparison compare(int subdivisions, bool quality, int states) {
  const PredictionRaster raster = prediction_raster(TiltedLineScan::paper(), RangeLimits());
  const FaceRefinement refinement(subdivisions);
  const auto finest = icosahedron_orientations(subdivisions);
  Refined refined(raster, RandomKnownRoom::kVoxel_m, refinement.orientations(), quality);
  Exhaustive exhaustive(raster, RandomKnownRoom::kVoxel_m, finest, quality);
  FactorWeights weights = {};
  weights[kQualityFactor] = quality ? 1.0 : 0.0;
  const ShortestPaths paths;  // no factor asks for them
  Comparison result;
  for (int state = 1; state <= states; ++state) {
    const RandomKnownRoom room(state);
    const KnownSpace space(room.map(),
                           quality ? KnownSpace::Surfaces::Keep : KnownSpace::Surfaces::Leave);
    const SensorPose elsewhere{Eigen::Vector3d::Constant(1e3), 0.0, 0.0};
    ViewEvaluator by_refinement(space, refined, weights, elsewhere, paths, &refinement);
    ViewEvaluator by_all(space, exhaustive, weights, elsewhere, paths);
    by_refinement.evaluate({&room.position_m(), 1});
    by_all.evaluate({&room.position_m(), 1});
    const BestView& found = by_refinement.at(room.position_m());
    const BestView& best = by_all.at(room.position_m());
    const double loss = best.fitness.value - found.fitness.value;
    EXPECT_GE(loss, -1e-12);
    EXPECT_GE(found.orientation, FaceRefinement::first_of(subdivisions));
    ++result.states;
    result.same += loss <= 1e-12 ? 1 : 0;
    result.evaluations += static_cast<double>(by_refinement.views_evaluated());
    result.largest_loss = std::max(result.largest_loss, loss);
  }
  result.evaluations /= static_cast<double>(finest.size()) * states;
  std::printf(
      "%zu orientations, quality %s: the best in %d of %d states, %.3f of the evaluations, "
      "at most %.3f worse\n",
      finest.size(), quality ? "on" : "off", result.same, result.states, result.evaluations,
      result.largest_loss);
  return result;
}

constexpr int kStates = 250;

void expect_found(const Comparison& comparison, double most_evaluations) {
  EXPECT_GE(comparison.same, 0.95 * comparison.states);
  EXPECT_LT(comparison.evaluations, most_evaluations);
  EXPECT_LT(comparison.largest_loss, 0.15);
}

TEST(FaceRefinement, FindsWhatAll320FindByTheSensorsOwnRays) {
  expect_found(compare<SelectiveViewPredictor, FastViewPredictor>(2, false, kStates), 0.57);
  expect_found(compare<SelectiveViewPredictor, FastViewPredictor>(2, true, kStates), 0.45);
}

TEST(FaceRefinement, FindsWhatAll1280FindByTheSensorsOwnRays) {
  expect_found(compare<SelectiveViewPredictor, FastViewPredictor>(3, false, kStates), 0.27);
  expect_found(compare<SelectiveViewPredictor, FastViewPredictor>(3, true, kStates), 0.2);
}

TEST(FaceRefinement, FindsWhatAll320FindByThePanorama) {
  expect_found(compare<PanoramaViewPredictor, PanoramaViewPredictor>(2, false, kStates), 0.57);
  expect_found(compare<PanoramaViewPredictor, PanoramaViewPredictor>(2, true, kStates), 0.45);
}

TEST(FaceRefinement, FindsWhatAll1280FindByThePanorama) {
  expect_found(compare<PanoramaViewPredictor, PanoramaViewPredictor>(3, false, kStates), 0.27);
  expect_found(compare<PanoramaViewPredictor, PanoramaViewPredictor>(3, true, kStates), 0.2);
}

}  // namespace
}  // namespace nextview
