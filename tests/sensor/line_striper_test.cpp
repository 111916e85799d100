#include "sensor/line_striper.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <stdexcept>

#include "tests/sensor/pixel_rays.h"

namespace nextview {
namespace {

TEST(LineStriper, StripesLieAtEvenAnglesAndTheirPointsAtEvenTangents) {
  const RayTable rays = make_ray_table(LineStriper{5, 5, 80.0 * kDegree, 90.0 * kDegree, 0.1});
  for (int u = 0; u < 5; ++u) {
    for (int v = 0; v < 5; ++v) {
      const Eigen::Vector3d ray = ray_at(rays, u, v);
      EXPECT_NEAR(ray.norm(), 1.0, 1e-15);
      EXPECT_NEAR(std::atan2(-ray.x(), ray.y()), (40.0 - 20.0 * u) * kDegree, 1e-15);
      EXPECT_NEAR(ray.z() / std::hypot(ray.x(), ray.y()), 1.0 - 0.5 * v, 1e-15);
    }
  }
}

// A stripe lies in a plane that holds the mirror's axis.
TEST(LineStriper, AStripeIsFlatAndUpright) {
  const RayTable rays = make_ray_table(LineStriper{});
  for (int u = 0; u < rays.rows(); u += 17) {
    const Eigen::Vector3d across = ray_at(rays, u, 3).cross(Eigen::Vector3d::UnitZ());
    for (int v = 0; v < rays.columns(); ++v) {
      EXPECT_NEAR(ray_at(rays, u, v).dot(across), 0.0, 1e-15);
    }
  }
}

TEST(LineStriper, RefusesWhatCannotBe) {
  EXPECT_THROW(make_ray_table(LineStriper{4, 1, 1.0, 1.0, 0.1}), std::invalid_argument);
  EXPECT_THROW(make_ray_table(LineStriper{4, 3, 180.0 * kDegree, 1.0, 0.1}), std::invalid_argument);
  EXPECT_THROW(make_ray_table(LineStriper{4, 3, 1.0, 180.0 * kDegree, 0.1}), std::invalid_argument);
  EXPECT_THROW(make_ray_table(LineStriper{4, 3, 1.0, 1.0, -0.1}), std::invalid_argument);
  EXPECT_THROW(make_ray_table(LineStriper{4, 3, 1.0, 1.0, std::nan("")}), std::invalid_argument);
}

}  // namespace
}  // namespace nextview
