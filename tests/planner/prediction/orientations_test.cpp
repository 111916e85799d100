#include "planner/prediction/orientations.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sensor/sensor_pose.h"

namespace nextview {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

double angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

TEST(Orientations, AreTwentyUnitVectorsEvenlySpread) {
  const auto orientations = icosahedron_orientations();
  ASSERT_EQ(orientations.size(), 20u);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Orientation& orientation : orientations) {
    EXPECT_NEAR(orientation.direction.norm(), 1.0, 1e-12);
    sum += orientation.direction;
    int neighbours = 0;
    int nearer = 0;
    for (const Orientation& other : orientations) {
      if (&other == &orientation) continue;
      const double between = angle(orientation.direction, other.direction);
      if (between < 41.80 * kDegree) ++nearer;
      if (std::abs(between - 41.81 * kDegree) < 0.01 * kDegree) ++neighbours;
    }
    EXPECT_EQ(neighbours, 3);
    EXPECT_EQ(nearer, 0);
  }
  EXPECT_NEAR(sum.norm(), 0.0, 1e-12);
}

TEST(Orientations, AreTheFaceCentresOfTheEdgeUpIcosahedron) {
  // The edge (0, -1, phi)-(0, 1, phi) is on top; its two faces' third corners are (+-phi, 0, 1).
  const double phi = std::numbers::phi;
  const Eigen::Vector3d top = Eigen::Vector3d(phi, 0.0, 2.0 * phi + 1.0).normalized();
  const auto orientations = icosahedron_orientations();
  EXPECT_EQ(std::count_if(orientations.begin(), orientations.end(),
                          [&](const Orientation& o) { return (o.direction - top).norm() < 1e-12; }),
            1);
}

TEST(Orientations, AreNeverVerticalAndAgreeWithPanAndTilt) {
  std::size_t checked = 0;
  for (int subdivisions = 0; subdivisions <= 3; ++subdivisions) {
    for (const Orientation& orientation : icosahedron_orientations(subdivisions)) {
      EXPECT_GT(std::hypot(orientation.direction.x(), orientation.direction.y()), 0.01);
      const Eigen::Vector3d back = viewing_direction(orientation.pan_rad, orientation.tilt_rad);
      EXPECT_NEAR((back - orientation.direction).norm(), 0.0, 1e-12);
      ++checked;
    }
  }
  EXPECT_EQ(checked, 20u + 80u + 320u + 1280u);
}

TEST(IcosahedronFaces, CoverTheSphereOnceHoweverOftenDivided) {
  std::size_t expected = 20;
  for (int subdivisions = 0; subdivisions <= 3; ++subdivisions, expected *= 4) {
    const auto faces = icosahedron_faces(subdivisions);
    ASSERT_EQ(faces.size(), expected);
    double solid_angle = 0.0;
    for (const auto& [a, b, c] : faces) {  // van Oosterom and Strackee
      solid_angle +=
          2.0 * std::atan2(std::abs(a.dot(b.cross(c))), 1.0 + a.dot(b) + b.dot(c) + c.dot(a));
    }
    EXPECT_NEAR(solid_angle, 4.0 * std::numbers::pi, 1e-9);
  }
}

TEST(IcosahedronFaces, RefuseWhatCannotBe) {
  EXPECT_THROW(icosahedron_faces(-1), std::invalid_argument);
  EXPECT_THROW(icosahedron_faces(7), std::invalid_argument);
}

TEST(RandomDirection, LiesInsideItsFaceAndReachesAllOfIt) {
  RandomStream random(7, 1, 1, RandomPurpose::InitialSimplex);
  int drawn = 0;
  for (const SphereTriangle& face : icosahedron_faces()) {
    const auto& [a, b, c] = face;
    std::array<int, 4> in_part{};
    for (int i = 0; i < 400; ++i, ++drawn) {
      const Eigen::Vector3d d = random_direction_in(face, random);
      EXPECT_NEAR(d.norm(), 1.0, 1e-12);
      Eigen::Matrix3d basis;
      basis << a, b, c;
      const Eigen::Vector3d weights = basis.inverse() * d;
      EXPECT_GE(weights.minCoeff(), -1e-12);
      // Which of the face's four parts: near a corner, or in the middle.
      int largest = 0;
      const double share = weights.maxCoeff(&largest) / weights.sum();
      ++in_part[share > 0.5 ? static_cast<std::size_t>(largest) : 3];
    }
    for (const int count : in_part) EXPECT_GT(count, 50);  // 100 expected
  }
  EXPECT_EQ(drawn, 8000);
}

}  // namespace
}  // namespace nextview
