#include "sensor/sensor_geometry.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "sensor/range_image.h"
#include "sensor/sensor_pose.h"
#include "tests/sensor/pixel_rays.h"

namespace nextview {
namespace {

TEST(TiltedLineScan, PaperSensorHasAVerticalApertureOf39Degrees) {
  const TiltedLineScan sensor = TiltedLineScan::paper();
  EXPECT_EQ(sensor.columns, 64);
  EXPECT_EQ(sensor.rows, 30);
  EXPECT_NEAR(sensor.horizontal_aperture_rad / kDegree, 60.0, 1e-12);
  EXPECT_NEAR(sensor.vertical_aperture_rad / kDegree, 39.07, 0.005);
}

// Corner (0, 0) is alpha/2 to the left and beta/2 up: R_a(alpha/2) Rx(beta/2) y.
TEST(TiltedLineScan, CornerRaysAreThoseOfEquation5) {
  const TiltedLineScan sensor = TiltedLineScan::paper();
  const RayTable rays = make_ray_table(sensor);
  const double half_beta = sensor.vertical_aperture_rad / 2.0;
  for (const int u : {0, 63}) {
    for (const int v : {0, 29}) {
      const double alpha = u == 0 ? 30.0 * kDegree : -30.0 * kDegree;
      const double beta = v == 0 ? half_beta : -half_beta;
      const Eigen::AngleAxisd row_tilt(beta, Eigen::Vector3d::UnitX());
      const Eigen::Vector3d a = row_tilt * Eigen::Vector3d::UnitZ();
      const Eigen::Vector3d expected =
          Eigen::AngleAxisd(alpha, a) * (row_tilt * Eigen::Vector3d::UnitY());
      EXPECT_LT((rays.ray(u, v) - expected).norm(), 1e-15) << u << ", " << v;
    }
  }
  const Eigen::Vector3d top_left = rays.ray(0, 0);
  EXPECT_DOUBLE_EQ(top_left.x(), -0.5);
  EXPECT_GT(top_left.z(), 0.0);
}

TEST(TiltedLineScan, AllRaysAreUnitVectors) {
  const RayTable rays = make_ray_table(TiltedLineScan::with_aperture(33, 17, 1.2));
  for (int v = 0; v < rays.rows(); ++v) {
    for (int u = 0; u < rays.columns(); ++u) {
      EXPECT_NEAR(rays.ray(u, v).norm(), 1.0, 1e-15);
    }
  }
}

TEST(TiltedLineScan, MiddlePixelOfAnOddRasterLooksForward) {
  const RayTable rays = make_ray_table(TiltedLineScan::with_aperture(5, 3, 1.0));
  EXPECT_EQ(rays.ray(2, 1), Eigen::Vector3d(0.0, 1.0, 0.0));
}

TEST(TiltedLineScan, RefusesRastersAndAperturesThatCannotBe) {
  EXPECT_THROW(TiltedLineScan::with_aperture(1, 30, 1.0), std::invalid_argument);
  EXPECT_THROW(TiltedLineScan::with_aperture(64, 1, 1.0), std::invalid_argument);
  EXPECT_THROW(TiltedLineScan::with_aperture(64, 30, 0.0), std::invalid_argument);
  EXPECT_THROW(TiltedLineScan::with_aperture(64, 30, 90.0 * kDegree), std::invalid_argument);
  EXPECT_THROW(TiltedLineScan::with_aperture(64, 30, std::nan("")), std::invalid_argument);
  EXPECT_THROW(make_ray_table(TiltedLineScan{}), std::invalid_argument);
}

TEST(SensorPose, ZeroAnglesLookAlongY) {
  EXPECT_EQ(world_from_sensor_rotation(0.0, 0.0), Eigen::Matrix3d::Identity());
  EXPECT_EQ(viewing_direction(0.0, 0.0), Eigen::Vector3d(0.0, 1.0, 0.0));
}

TEST(SensorPose, PositivePanTurnsLeftAndPositiveTiltLooksUp) {
  EXPECT_LT((viewing_direction(90.0 * kDegree, 0.0) - Eigen::Vector3d(-1, 0, 0)).norm(), 1e-15);
  EXPECT_LT((viewing_direction(0.0, 90.0 * kDegree) - Eigen::Vector3d(0, 0, 1)).norm(), 1e-15);
}

TEST(SensorPose, RotationIsPanAfterTilt) {
  const double pan = 0.7;
  const double tilt = -0.4;
  const Eigen::Matrix3d expected = (Eigen::AngleAxisd(pan, Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX()))
                                       .toRotationMatrix();
  EXPECT_LT((world_from_sensor_rotation(pan, tilt) - expected).norm(), 1e-15);
  // Pan and tilt come back from the direction as P20 says.
  const Eigen::Vector3d d = viewing_direction(pan, tilt);
  EXPECT_NEAR(std::atan2(-d.x(), d.y()), pan, 1e-15);
  EXPECT_NEAR(std::asin(d.z()), tilt, 1e-15);
}

TEST(QuantiseRange, RoundsToTenthsOfAMillimetreAndKeepsNoReturnAndInvalidApart) {
  EXPECT_FLOAT_EQ(quantise_range(1.23454), 1.2345F);
  EXPECT_FLOAT_EQ(quantise_range(1.23456), 1.2346F);
  EXPECT_EQ(quantise_range(0.0), 0.0F);
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(quantise_range(infinity), std::numeric_limits<float>::infinity());
  EXPECT_TRUE(std::isnan(quantise_range(std::nan(""))));
}

}  // namespace
}  // namespace nextview
