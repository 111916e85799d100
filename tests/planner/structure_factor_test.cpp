#include "planner/structure_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

namespace nextview {
namespace {

using Eigen::Vector3d;

// So many voxels with that normal.
struct Plane {
  int voxels;
  Vector3d normal;
};

double structure_of(std::initializer_list<Plane> planes,
                    const Eigen::Quaterniond& turned = Eigen::Quaterniond::Identity()) {
  ViewCounts counts;
  for (const Plane& plane : planes) {
    for (int i = 0; i < plane.voxels; ++i) {
      counts.normals.add(quantise_direction(turned * plane.normal.normalized()));
    }
  }
  return structure_factor(counts);
}

const Vector3d kX = Vector3d::UnitX();
const Vector3d kY = Vector3d::UnitY();
const Vector3d kZ = Vector3d::UnitZ();

TEST(StructureFactor, OfACornerOfThreePlanesSeenAlikeIsOne) {
  EXPECT_NEAR(structure_of({{50, kX}, {50, -kY}, {50, kZ}}), 1.0, 1e-12);
}

TEST(StructureFactor, OfABareWallIsZero) {
  EXPECT_EQ(structure_of({{150, kX}}), 0.0);
  EXPECT_NEAR(structure_of({{150, {1.0, 2.0, -3.0}}}), 0.0, 1e-3) << "normals are rounded";
}

// They differ in sign only: one slides along both.
TEST(StructureFactor, OfTwoParallelWallsIsZero) {
  EXPECT_EQ(structure_of({{40, kX}, {60, -kX}}), 0.0);
}

// One slides along the edge.
TEST(StructureFactor, OfAnEdgeIsZero) {
  EXPECT_EQ(structure_of({{50, kX}, {50, kY}}), 0.0);
  EXPECT_NEAR(structure_of({{50, {1.0, 2.0, -3.0}}, {50, {3.0, 1.0, 1.0}}}), 0.0, 1e-3);
}

// Of 100 voxels the plane seen least has 10: three times its share.
TEST(StructureFactor, OfACornerIsThreeTimesTheShareOfThePlaneSeenLeast) {
  EXPECT_NEAR(structure_of({{60, kX}, {30, kY}, {10, kZ}}), 0.3, 1e-12);
}

// Normals at 45 degrees to each other in a plane, and one across: N in their plane is
// ((2 + 1, 1), (1, 1)) / 8 by 2 x (1, 0) and 2 x (1, 1) / sqrt 2, whose eigenvalues are
// (4 +- sqrt 8) / 16, and across it 4 / 8. The least of them, times 3.
TEST(StructureFactor, OfAnObtuseEdgeIsLessThanOfARightOne) {
  const double structure = structure_of({{2, kX}, {2, {1.0, 1.0, 0.0}}, {4, kZ}});
  EXPECT_NEAR(structure, 3.0 * (4.0 - std::sqrt(8.0)) / 16.0, 1e-3);
  EXPECT_LT(structure, structure_of({{2, kX}, {2, kY}, {4, kZ}}));
}

TEST(StructureFactor, DoesNotCountVoxelsWithoutANormal) {
  EXPECT_EQ(structure_of({}), 0.0);
  ViewCounts counts;
  counts.occupied_voxels = 3;
  for (const QuantisedDirection& normal :
       {QuantisedDirection{16384, 0, 0}, {0, 16384, 0}, {0, 0, 16384}, {0, 0, 0}}) {
    counts.normals.add(normal);
  }
  EXPECT_NEAR(structure_factor(counts), 1.0, 1e-12);
}

TEST(StructureFactor, LiesBetweenZeroAndOneAndTurnsWithTheWorld) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto any = [&] { return Vector3d(normal(random), normal(random), normal(random)); };
  double least = 1.0;
  double most = 0.0;
  for (int round = 0; round < 2000; ++round) {
    const Plane planes[] = {
        {1 + round % 5, any()}, {1 + round % 7, any()}, {1, any()}, {round % 2, any()}};
    const Eigen::Quaterniond turn(normal(random), normal(random), normal(random), normal(random));
    const auto structure = [&](const Eigen::Quaterniond& turned) {
      return structure_of({planes[0], planes[1], planes[2], planes[3]}, turned);
    };
    const double value = structure(Eigen::Quaterniond::Identity());
    EXPECT_NEAR(structure(turn.normalized()), value, 1e-3);
    least = std::min(least, value);
    most = std::max(most, value);
  }
  EXPECT_GE(least, 0.0);
  EXPECT_LT(least, 0.01);
  EXPECT_GT(most, 0.7);
  EXPECT_LE(most, 1.0);
}

}  // namespace
}  // namespace nextview
