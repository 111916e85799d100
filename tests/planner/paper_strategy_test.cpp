#include "planner/paper_strategy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "planner/prediction/selective_view_predictor.h"
#include "planner/view_evaluator.h"

namespace nextview {
namespace {

using Eigen::Vector3d;

// A hall of 3.8 x 3.8 x 1.8 m: Empty inside walls, of which one has not been seen.
class Hall : public ::testing::Test {
 protected:
  Hall()
      : map({0.1, Vector3d::Zero()}, {VoxelIndex::Zero(), VoxelIndex(40, 40, 20)}),
        predictor(prediction_raster(TiltedLineScan::with_aperture(8, 4, 1.0), {}), 0.1,
                  icosahedron_orientations(), false) {
    for (int k = 0; k < 20; ++k) {
      for (int j = 0; j < 40; ++j) {
        for (int i = 0; i < 40; ++i) {
          const bool wall = k == 0 || k == 19 || j == 0 || i == 0 || i == 39;
          const Label label = wall ? Label::Occupied : j == 39 ? Label::Unmarked : Label::Empty;
          map.set_label({i, j, k}, label);
        }
      }
    }
  }

  std::optional<Decision> try_to_decide(std::int64_t seed, int attempt = 1) {
    const KnownSpace space(map);
    ClearSpace clear(map, parameters.feasibility);
    RefusedPlaces places;
    for (std::size_t i = 0; i < refused.size(); ++i) {
      places.add(clear, std::vector{present.position_m, refused[i].position_m}, i + 1);
    }
    ShortestPaths paths;
    paths.stand_at(clear, map, present.position_m, parameters.feasibility.departure_m);
    return decide_by_simplex({space, present, seed, 2, attempt, refused}, paths, predictor,
                             parameters);
  }

  Decision decide(std::int64_t seed, int attempt = 1) {
    const auto decision = try_to_decide(seed, attempt);
    EXPECT_TRUE(decision.has_value());
    return decision.value_or(Decision{});
  }

  VoxelMap map;
  PlainViewPredictor predictor;
  PlannerParameters parameters;
  SensorPose present{{0.8, 0.8, 0.7}, 0.0, 0.0};
  std::vector<SensorPose> refused;
};

bool same(const Decision& a, const Decision& b) {
  if (a.tried.size() != b.tried.size()) return false;
  for (std::size_t i = 0; i < a.tried.size(); ++i) {
    if (a.tried[i].position_m != b.tried[i].position_m) return false;
    if (a.tried[i].fitness != b.tried[i].fitness) return false;
  }
  return a.pose.position_m == b.pose.position_m && a.pose.pan_rad == b.pose.pan_rad &&
         a.pose.tilt_rad == b.pose.tilt_rad && a.fitness.value == b.fitness.value;
}

TEST_F(Hall, TheSameArgumentsGiveTheSameView) {
  for (int seed = 1; seed <= 10; ++seed) EXPECT_TRUE(same(decide(seed), decide(seed)));
}

TEST_F(Hall, AnotherSeedOrAttemptSearchesElsewhere) {
  EXPECT_FALSE(same(decide(1), decide(2)));
  EXPECT_FALSE(same(decide(1, 1), decide(1, 2)));
}

TEST_F(Hall, TheViewIsTheBestOfAllTried) {
  for (int seed = 1; seed <= 10; ++seed) {
    const Decision decision = decide(seed);
    EXPECT_EQ(decision.evaluations, static_cast<int>(decision.tried.size()));
    EXPECT_EQ(decision.tried[0].position_m, present.position_m);
    EXPECT_EQ(decision.tried[0].move, SimplexMove::FirstVertex);
    for (const TriedPosition& tried : decision.tried) {
      EXPECT_LE(tried.fitness, decision.fitness.value);
    }
    EXPECT_EQ(decision.waypoints_m.front(), present.position_m);
    EXPECT_EQ(decision.waypoints_m.back(), decision.pose.position_m);
  }
}

TEST_F(Hall, TheFitnessIsWhatThePredictorSaysOfTheView) {
  const Decision decision = decide(3);
  std::vector<ViewCounts> counts(20);
  predictor.predict(KnownSpace(map), map.grid().voxel_of(decision.pose.position_m), counts);
  double best = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    best = std::max(best, fitness(counts[i]).value);
  }
  EXPECT_EQ(decision.fitness.value, best);
  // Only a view that has the unseen wall in sight is better than one of nothing new.
  EXPECT_GT(decision.fitness.value, 0.5);
  EXPECT_GT(decision.fitness.share_unseen, 0.0);
}

// The present position has the path of length 0, and all others the one that would be taken.
TEST_F(Hall, TheWayCountsByTheRealPath) {
  parameters.weights[kNavigationFactor] = 0.1;
  int moved = 0;
  for (int seed = 1; seed <= 10; ++seed) {
    const Decision decision = decide(seed);
    std::vector<ViewCounts> counts(20);
    const auto best_at = [&](const Vector3d& position_m, const Travel& travel) {
      predictor.predict(KnownSpace(map), map.grid().voxel_of(position_m), counts);
      double best = 0.0;
      for (const ViewCounts& view : counts) {
        best = std::max(best, fitness(view, travel, parameters.weights).value);
      }
      return best;
    };
    const Travel travel = travel_along(decision.waypoints_m);
    EXPECT_NEAR(decision.fitness.value, best_at(decision.pose.position_m, travel), 1e-9);
    EXPECT_EQ(decision.fitness.factors[kNavigationFactor], navigation_factor(travel));
    EXPECT_NEAR(decision.tried[0].fitness, best_at(present.position_m, {}), 1e-9);
    if (travel.length_m > 0.0) ++moved;
  }
  EXPECT_GT(moved, 0);
}

// Round a corner of 90 degrees, so that the way has both a length and a turn.
TEST_F(Hall, AViewAloneIsWorthWhatItIsAmongAll) {
  for (int k = 0; k < 20; ++k) {
    for (int j = 0; j < 26; ++j) map.set_label({18, j, k}, Label::Occupied);
  }
  const Vector3d behind_m(3.05, 0.85, 0.75);
  const KnownSpace space(map);
  const ClearSpace clear(map, parameters.feasibility);
  ShortestPaths paths;
  paths.find(clear, map, present.position_m, 0.3);
  FactorWeights weights = {};
  weights[kNavigationFactor] = 1.0;
  ViewEvaluator evaluator(space, predictor, weights, present, paths);
  evaluator.evaluate({&behind_m, 1});
  const BestView& best = evaluator.at(behind_m);
  const Fitness alone = evaluator.of_view(behind_m, best.orientation);
  EXPECT_EQ(alone.value, best.fitness.value);
  EXPECT_EQ(alone.factors, best.fitness.factors);
  const Travel travel = travel_along(paths.waypoints_to_m(behind_m));
  EXPECT_GT(travel.turning, 0.0);
  EXPECT_GT(travel.length_m, 2.0 * 2.1) << "to the end of the wall and back";
  EXPECT_EQ(alone.factors[kNavigationFactor], navigation_factor(travel));
}

// At each of the positions tried the search among 80 directions finds no less than in the twenty.
TEST_F(Hall, TheViewIsOneOfTheFinestWhereFacesAreRefined) {
  const PredictionRaster raster = prediction_raster(TiltedLineScan::with_aperture(8, 4, 1.0), {});
  const FaceRefinement& refinement = parameters.refinement.emplace(1);
  SelectiveViewPredictor refined(raster, 0.1, refinement.orientations(), false);
  const KnownSpace space(map);
  const ClearSpace clear(map, parameters.feasibility);
  for (int seed = 1; seed <= 5; ++seed) {
    ShortestPaths paths;
    paths.stand_at(clear, map, present.position_m, parameters.feasibility.departure_m);
    const auto decision =
        decide_by_simplex({space, present, seed, 2, 1, {}}, paths, refined, parameters);
    ASSERT_TRUE(decision.has_value());
    const Vector3d direction = viewing_direction(decision->pose.pan_rad, decision->pose.tilt_rad);
    const auto nearest = std::ranges::max_element(
        refinement.finest(), {},
        [&](const Orientation& orientation) { return orientation.direction.dot(direction); });
    EXPECT_NEAR(nearest->direction.dot(direction), 1.0, 1e-12);
    PlainViewPredictor plain(raster, 0.1, {*nearest}, false);
    std::vector<ViewCounts> counts(1);
    plain.predict(space, map.grid().voxel_of(decision->pose.position_m), counts);
    EXPECT_EQ(decision->fitness.value, fitness(counts[0]).value);
    EXPECT_GT(decision->fitness.value, 0.5);
  }
}

TEST_F(Hall, ARefinementWithOtherOrientationsThanThePredictorsIsRefused) {
  parameters.refinement.emplace(1);
  EXPECT_THROW(try_to_decide(1), std::invalid_argument);
}

TEST_F(Hall, LimitsAreKept) {
  parameters.feasibility.lift_min_m = 0.5;
  parameters.feasibility.lift_max_m = 1.1;
  parameters.feasibility.workspace_min_m = {0.5, 0.5, 0.0};
  parameters.feasibility.workspace_max_m = {1.5, 2.0, 2.0};
  int moved = 0;
  for (int seed = 1; seed <= 20; ++seed) {
    const Vector3d position_m = decide(seed).pose.position_m;
    EXPECT_GE(position_m.z(), 0.5);
    EXPECT_LE(position_m.z(), 1.1);
    EXPECT_GE(position_m.x(), 0.5);
    EXPECT_LE(position_m.x(), 1.5);
    EXPECT_LE(position_m.y(), 2.0);
    if (position_m != present.position_m) ++moved;
  }
  EXPECT_GT(moved, 0);
}

TEST_F(Hall, RefusedGoalsAreAvoided) {
  int compared = 0;
  for (int seed = 1; seed <= 10; ++seed) {
    refused.clear();
    const SensorPose first = decide(seed).pose;
    if (first.position_m == present.position_m) continue;
    refused.push_back(first);
    const Vector3d second_m = decide(seed).pose.position_m;
    const double away_m = (first.position_m - present.position_m).norm();
    // Between the centres of their voxels; at the present position the robot is already.
    if (second_m == present.position_m) continue;
    const VoxelGrid& grid = map.grid();
    EXPECT_GE((grid.voxel_of(second_m) - grid.voxel_of(first.position_m)).cast<double>().norm(),
              std::min(parameters.feasibility.clearance_m, 0.5 * away_m) / 0.1 - 1e-6);
    ++compared;
  }
  EXPECT_GT(compared, 3);
}

// Within the departure the body may stand in what nobody has seen, as it must at the first move;
// afterwards only as near as the later departure says, or what hides there is run into.
TEST_F(Hall, AfterTheFirstMoveTheBodyStaysInTheKnown) {
  present.position_m = {2.0, 3.2, 0.9};
  parameters.later_departure_m = 0.3;
  const auto new_predictor = [] {
    return std::make_unique<PlainViewPredictor>(
        prediction_raster(TiltedLineScan::with_aperture(8, 4, 1.0), {}), 0.1,
        icosahedron_orientations(), false);
  };
  const KnownSpace space(map);
  // How near to the unseen wall, whose boxes begin at 3.85 m, positions were tried.
  const auto nearest_m = [&](int view) {
    double nearest_m = 10.0;
    for (int seed = 1; seed <= 20; ++seed) {
      PaperStrategy strategy(parameters, {}, 0.1, new_predictor(), new_predictor());
      const NextView next = strategy.next_view({space, present, seed, view, 1, {}});
      for (const TriedPosition& tried : std::get<Decision>(next).tried) {
        if (tried.fitness < 0.0) continue;  // infeasible
        const double center_m = map.grid().center_m(map.grid().voxel_of(tried.position_m)).y();
        nearest_m = std::min(nearest_m, 3.85 - center_m);
      }
    }
    return nearest_m;
  };
  EXPECT_LT(nearest_m(2), parameters.feasibility.body_radius_m);
  EXPECT_GE(nearest_m(3), parameters.feasibility.body_radius_m - 1e-9);
}

// Boxed in, the robot can only turn, and the direction it has just looked in is not taken again
// although it is the best there is.
TEST_F(Hall, TheScanJustTakenIsNotRepeated) {
  parameters.feasibility.workspace_min_m = present.position_m - Vector3d::Constant(1e-3);
  parameters.feasibility.workspace_max_m = present.position_m + Vector3d::Constant(1e-3);
  const SensorPose best = decide(1).pose;
  present.pan_rad = best.pan_rad;
  present.tilt_rad = best.tilt_rad;
  const SensorPose next = decide(1).pose;
  EXPECT_TRUE(next.pan_rad != best.pan_rad || next.tilt_rad != best.tilt_rad);
}

TEST_F(Hall, NothingFeasibleIsNoDecision) {
  refused.push_back(present);
  parameters.feasibility.workspace_max_m = {0.9, 0.9, 0.8};
  parameters.feasibility.workspace_min_m = {0.85, 0.85, 0.75};
  EXPECT_FALSE(try_to_decide(1).has_value());
}

TEST_F(Hall, ParametersThatCannotBeAreNamed) {
  const auto message = [&](auto change) {
    parameters = {};
    change(parameters);
    try {
      try_to_decide(1);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  using P = PlannerParameters;
  EXPECT_EQ(message([](P&) {}), "accepted");
  EXPECT_EQ(message([](P& p) { p.step_min_m = 0.0; }),
            "step_min_m or step_max_m = 0 is not a number from 0.0001 to 100000");
  EXPECT_EQ(message([](P& p) { p.step_max_m = 0.1; }), "step_max_m must be at least step_min_m");
  EXPECT_EQ(message([](P& p) { p.fitness_tolerance = -1.0; }),
            "fitness_tolerance = -1 is not a number from 0 to 2");
  EXPECT_EQ(message([](P& p) { p.max_evaluations = 3; }),
            "max_evaluations = 3 is not a number from 4 to 1200");
  EXPECT_EQ(message([](P& p) { p.feasibility.clearance_m = -1.0; }),
            "clearance_m = -1 is not a number from 0 to 5");
  EXPECT_EQ(message([](P& p) { p.weights[kNavigationFactor] = 10.5; }),
            "structure_weight or navigation_weight = 10.5 is not a number from 0 to 10");
  EXPECT_EQ(message([](P& p) { p.weights[kNavigationFactor] = 1.0; }), "accepted");
  for (const std::size_t factor : {kQualityFactor, kStructureFactor}) {
    EXPECT_EQ(message([&](P& p) { p.weights[factor] = 1.0; }),
              "a factor asks for the surfaces, which the view predictor does not count");
  }
}

}  // namespace
}  // namespace nextview
