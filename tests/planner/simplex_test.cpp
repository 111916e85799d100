#include "planner/simplex.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <span>
#include <stdexcept>
#include <vector>

#include "sensor/random_stream.h"

namespace nextview {
namespace {

using Eigen::Vector3d;
constexpr double kInfeasible = -std::numeric_limits<double>::infinity();

const std::array<Vector3d, 4> kCorner = {Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY(),
                                         Vector3d::UnitZ()};

// Of a function that answers one position at a time.
SimplexResult maximise_by_simplex(const std::array<Vector3d, 4>& vertices,
                                  const std::function<double(const Vector3d&)>& value,
                                  double tolerance, int max_evaluations) {
  const auto values = [&value](std::span<const Vector3d> positions) {
    std::vector<double> result;
    for (const Vector3d& position : positions) result.push_back(value(position));
    return result;
  };
  return nextview::maximise_by_simplex(vertices, ValuesOfPositions(values), tolerance,
                                       max_evaluations);
}

TEST(Simplex, ClimbsToAKnownTop) {
  const Vector3d top(1.7, -0.4, 2.2);
  const auto result = maximise_by_simplex(
      kCorner, [&](const Vector3d& p) { return 1.0 - (p - top).squaredNorm(); }, 1e-9, 500);
  EXPECT_NEAR((result.best.position - top).norm(), 0.0, 1e-3);
  EXPECT_NEAR(result.best.value, 1.0, 1e-6);
  EXPECT_GT(result.iterations, 10);
  EXPECT_LT(result.tried.size(), 500u);
}

TEST(Simplex, UsesEveryMove) {
  std::set<SimplexMove> seen;
  // A curved ridge, which a simplex has to shrink on.
  const auto ridge = [](const Vector3d& p) {
    return -100.0 * std::abs(p.y() - p.x() * p.x()) - std::abs(1.0 - p.x()) - std::abs(p.z());
  };
  for (const SimplexTrial& trial : maximise_by_simplex(kCorner, ridge, 1e-6, 400).tried) {
    seen.insert(trial.move);
  }
  EXPECT_EQ(seen, (std::set<SimplexMove>{SimplexMove::FirstVertex, SimplexMove::InitialVertex,
                                         SimplexMove::Reflection, SimplexMove::Expansion,
                                         SimplexMove::Contraction1D, SimplexMove::Contraction3D}));
}

// By hand: on f = x the values are 0, 1, 0, 0. The best is UnitX; of the three equal others the one
// that came last, UnitZ, counts as the worst and is reflected.
TEST(Simplex, ReflectsTheYoungestOfEqualWorstVertices) {
  const auto result = maximise_by_simplex(
      kCorner, [](const Vector3d& p) { return p.x(); }, 0.0, 5);
  const Vector3d face = (kCorner[0] + kCorner[1] + kCorner[2]) / 3.0;
  ASSERT_GE(result.tried.size(), 5u);
  EXPECT_EQ(result.tried[4].move, SimplexMove::Reflection);
  EXPECT_NEAR((result.tried[4].position - (2.0 * face - kCorner[3])).norm(), 0.0, 1e-12);
}

// So that they can be worked out together.
TEST(Simplex, AsksForAllPositionsAtOnceThatItNeedsBeforeItGoesOn) {
  std::vector<std::size_t> asked;
  const ValuesOfPositions ridge = [&asked](std::span<const Vector3d> positions) {
    asked.push_back(positions.size());
    std::vector<double> values;
    for (const Vector3d& p : positions) {
      values.push_back(-100.0 * std::abs(p.y() - p.x() * p.x()) - std::abs(1.0 - p.x()));
    }
    return values;
  };
  const auto result = nextview::maximise_by_simplex(kCorner, ridge, 1e-6, 400);
  const auto shrunk = std::count_if(
      result.tried.begin(), result.tried.end(),
      [](const SimplexTrial& trial) { return trial.move == SimplexMove::Contraction3D; });
  ASSERT_GT(shrunk, 0);
  EXPECT_EQ(asked.front(), 4u);
  EXPECT_EQ(3 * std::count(asked.begin(), asked.end(), 3u), shrunk);
  EXPECT_EQ(4 + shrunk + std::count(asked.begin(), asked.end(), 1u), std::ssize(result.tried));
}

TEST(Simplex, AFlatFunctionStopsAtOnce) {
  const auto result = maximise_by_simplex(
      kCorner, [](const Vector3d&) { return 0.5; }, 0.01, 70);
  EXPECT_EQ(result.iterations, 0);
  EXPECT_EQ(result.tried.size(), 4u);
  EXPECT_EQ(result.best.position, kCorner[0]);  // the oldest of equals
}

TEST(Simplex, NothingFeasibleStopsAtOnce) {
  const auto result = maximise_by_simplex(
      kCorner, [](const Vector3d&) { return kInfeasible; }, 0.01, 70);
  EXPECT_EQ(result.tried.size(), 4u);
  EXPECT_EQ(result.best.value, kInfeasible);
}

TEST(Simplex, KeepsToTheBudgetButForOneIteration) {
  const auto result = maximise_by_simplex(
      kCorner, [](const Vector3d& p) { return p.sum(); }, 0.0, 30);
  EXPECT_GE(result.tried.size(), 30u);
  EXPECT_LE(result.tried.size(), 34u);
}

TEST(Simplex, ClimbsAlongAWallItMustNotCross) {
  const auto walled = [](const Vector3d& p) {
    return p.x() > 0.5 ? kInfeasible : -(p - Vector3d(0.8, 0.3, 0.3)).squaredNorm();
  };
  const auto result = maximise_by_simplex(kCorner, walled, 1e-6, 400);
  EXPECT_LE(result.best.position.x(), 0.5);
  EXPECT_GT(result.best.value, -0.12);  // -0.09 at the foot of the top
}

TEST(Simplex, ContractsToTheOnlyFeasibleVertex) {
  const auto ball = [](const Vector3d& p) {
    return p.norm() < 0.05 ? 1.0 - p.norm() : kInfeasible;
  };
  const auto result = maximise_by_simplex(kCorner, ball, 0.5, 200);
  EXPECT_EQ(result.best.value, 1.0);
  EXPECT_LT(result.tried.size(), 200u);  // all four are in the ball before the budget ends
}

TEST(Simplex, APositionThatIsFeasibleAloneEndsByTheBudget) {
  const auto point = [](const Vector3d& p) { return p.isZero(0.0) ? 1.0 : kInfeasible; };
  const auto result = maximise_by_simplex(kCorner, point, 0.5, 70);
  EXPECT_EQ(result.best.position, Vector3d::Zero());
  EXPECT_GE(result.tried.size(), 70u);
}

TEST(Simplex, ReturnsTheBestOfAllItTriedAndAlwaysTheSame) {
  int cases = 0;
  for (int seed = 0; seed < 500; ++seed, ++cases) {
    RandomStream random(seed, 1, 1, RandomPurpose::InitialSimplex);
    std::array<Vector3d, 4> vertices;
    for (Vector3d& vertex : vertices) {
      vertex = Vector3d(random.uniform(), random.uniform(), random.uniform()) * 4.0;
    }
    // Steps, plateaus and holes, as the fitness of voxels has.
    const auto rough = [](const Vector3d& p) {
      const Vector3d cell = (p * 3.0).array().floor();
      const double value = std::sin(cell.x()) + std::cos(2.0 * cell.y()) + std::sin(3.0 * cell.z());
      return value < -1.0 ? kInfeasible : value;
    };
    const auto result = maximise_by_simplex(vertices, rough, 0.01, 70);
    double best = kInfeasible;
    for (const SimplexTrial& trial : result.tried) best = std::max(best, trial.value);
    EXPECT_EQ(result.best.value, best);
    EXPECT_LE(result.tried.size(), 74u);
    const auto again = maximise_by_simplex(vertices, rough, 0.01, 70);
    ASSERT_EQ(again.tried.size(), result.tried.size());
    EXPECT_EQ(again.best.position, result.best.position);
  }
  EXPECT_EQ(cases, 500);
}

TEST(Simplex, RefusesWhatCannotBe) {
  const auto flat = [](const Vector3d&) { return 0.0; };
  EXPECT_THROW(maximise_by_simplex(kCorner, flat, 0.01, 3), std::invalid_argument);
  EXPECT_THROW(maximise_by_simplex(kCorner, flat, -1.0, 70), std::invalid_argument);
  EXPECT_THROW(maximise_by_simplex(kCorner, flat, std::nan(""), 70), std::invalid_argument);
}

}  // namespace
}  // namespace nextview
