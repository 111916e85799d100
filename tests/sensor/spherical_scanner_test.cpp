#include "sensor/spherical_scanner.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>
#include <stdexcept>

#include "tests/sensor/pixel_rays.h"

namespace nextview {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(SphericalScanner, RaysAreRotationsOfTheOpticalAxis) {
  const SphericalScanner sensor{7, 5, 240.0 * kDegree, 100.0 * kDegree};
  const RayTable rays = make_ray_table(sensor);
  EXPECT_EQ(rays.rows(), 7);
  EXPECT_EQ(rays.columns(), 5);
  for (int u = 0; u < 7; ++u) {
    for (int v = 0; v < 5; ++v) {
      const double phi = (120.0 - 40.0 * u) * kDegree;
      const double theta = (50.0 - 25.0 * v) * kDegree;
      const Eigen::Vector3d expected =
          Eigen::AngleAxisd(phi, Eigen::Vector3d::UnitZ()) *
          (Eigen::AngleAxisd(theta, Eigen::Vector3d::UnitX()) * Eigen::Vector3d::UnitY());
      EXPECT_LT((ray_at(rays, u, v) - expected).norm(), 1e-15) << u << ", " << v;
    }
  }
  // The middle of the picture looks ahead, its left end to the left and behind, its top up.
  EXPECT_LT((ray_at(rays, 3, 2) - Eigen::Vector3d::UnitY()).norm(), 1e-15);
  EXPECT_LT(ray_at(rays, 0, 2).x(), -0.8);
  EXPECT_LT(ray_at(rays, 0, 2).y(), -0.4);
  EXPECT_NEAR(ray_at(rays, 3, 0).z(), std::sin(50.0 * kDegree), 1e-15);
}

TEST(SphericalScanner, AWholeTurnHasNoColumnTwice) {
  const RayTable rays = make_ray_table(SphericalScanner{8, 3, 2.0 * kPi, 100.0 * kDegree});
  for (int u = 0; u < 8; ++u) {
    const int next = (u + 1) % 8;
    const double step = std::acos(ray_at(rays, u, 1).dot(ray_at(rays, next, 1)));
    EXPECT_NEAR(step, kPi / 4.0, 1e-12) << "from column " << u;
  }
  // Evenly about the optical axis: an even number of columns has it in the middle of two.
  EXPECT_NEAR(ray_at(rays, 3, 1).x(), -ray_at(rays, 4, 1).x(), 1e-15);
  EXPECT_GT(ray_at(rays, 3, 1).y(), 0.9);
}

TEST(SphericalScanner, ReachesNoPole) {
  const RayTable rays = make_ray_table(SphericalScanner{});
  double highest = 0.0;
  for (int u = 0; u < rays.rows(); ++u) {
    for (int v = 0; v < rays.columns(); ++v) {
      highest = std::max(highest, std::abs(ray_at(rays, u, v).z()));
    }
  }
  EXPECT_NEAR(highest, std::sin(50.0 * kDegree), 1e-12);
}

TEST(SphericalScanner, RefusesWhatCannotBe) {
  EXPECT_NO_THROW(make_ray_table(SphericalScanner{4, 3, 360.0 * kDegree, 1.0}));
  EXPECT_THROW(make_ray_table(SphericalScanner{4, 3, 361.0 * kDegree, 1.0}), std::invalid_argument);
  EXPECT_THROW(make_ray_table(SphericalScanner{4, 3, 0.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(make_ray_table(SphericalScanner{4, 3, 1.0, kPi}), std::invalid_argument);
  EXPECT_THROW(make_ray_table(SphericalScanner{1, 3, 1.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(make_ray_table(SphericalScanner{4, 3, std::nan(""), 1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace nextview
