#include "sensor/ray_table.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <vector>

#include "sensor/sensor_geometry.h"
#include "sensor/sensor_pose.h"

namespace nextview {
namespace {

std::vector<SensorGeometry> one_of_each() {
  return {TiltedLineScan::with_aperture(9, 6, 1.1), SphericalScanner{12, 7, 6.0, 1.7},
          LineStriper{8, 11, 1.0, 0.9, 0.1}};
}

// What loops over rows make of a ray is what the formula of its sensor says, turned into the world.
TEST(RayTable, RowsInTheWorldAreTheRaysTurned) {
  const Eigen::Matrix3d world_from_sensor = world_from_sensor_rotation(0.7, -0.4);
  int rays = 0;
  for (const SensorGeometry& sensor : one_of_each()) {
    const RayTable table = make_ray_table(sensor);
    const Eigen::Matrix3d world_from_lines = table.world_from_lines(world_from_sensor);
    for (int v = 0; v < table.rows(); ++v) {
      const RayRow row = table.row(v, world_from_lines);
      for (int u = 0; u < table.columns(); ++u) {
        const auto column = static_cast<std::size_t>(u);
        const Eigen::Vector3d ray = row.ray(table.column_sin[column], table.column_cos[column]);
        EXPECT_LT((ray - world_from_sensor * table.ray(u, v)).norm(), 1e-15);
        for (int k = 0; k < 3; ++k) {
          EXPECT_EQ(row.along(k).ray(table.column_sin[column], table.column_cos[column]), ray[k]);
        }
        ++rays;
      }
    }
  }
  EXPECT_EQ(rays, 9 * 6 + 12 * 7 + 8 * 11);
}

// n, dn/da and (dn/db) / cos a by differences of the rays themselves.
TEST(RayTable, TheFrameOfARayIsItAndItsDerivatives) {
  constexpr double kStep = 1e-6;
  for (const double a : {-0.9, 0.0, 0.3}) {
    for (const double b : {-2.5, -0.4, 0.0, 1.9}) {
      const auto ray = [](double angle_a, double angle_b) {
        return RayTable{{std::sin(angle_a)},
                        {std::cos(angle_a)},
                        {std::sin(angle_b)},
                        {std::cos(angle_b)},
                        SensorKind::TiltedLineScan}
            .ray(0, 0);
      };
      const RayFrame<double> frame{std::sin(a), std::cos(a), std::sin(b), std::cos(b)};
      const auto vector = [&](double r, double s, double t) {
        const auto [x, y, z] = frame.vector(r, s, t);
        return Eigen::Vector3d(x, y, z);
      };
      const Eigen::Vector3d n_a = (ray(a + kStep, b) - ray(a - kStep, b)) / (2.0 * kStep);
      const Eigen::Vector3d n_b = (ray(a, b + kStep) - ray(a, b - kStep)) / (2.0 * kStep);
      EXPECT_LT((vector(1, 0, 0) - ray(a, b)).norm(), 1e-15);
      EXPECT_LT((vector(0, 1, 0) - n_a).norm(), 1e-9);
      EXPECT_LT((vector(0, 0, 1) - n_b / std::cos(a)).norm(), 1e-9);
      EXPECT_LT(
          (vector(2, -3, 4) - (2 * vector(1, 0, 0) - 3 * vector(0, 1, 0) + 4 * vector(0, 0, 1)))
              .norm(),
          1e-15);
    }
  }
}

TEST(RayTable, LinesAreTurnedAndNotMirrored) {
  for (int kind = 0; kind < kSensorKinds; ++kind) {
    const Eigen::Matrix3d turn = sensor_from_lines(static_cast<SensorKind>(kind));
    EXPECT_EQ(turn * turn.transpose(), Eigen::Matrix3d::Identity());
    EXPECT_EQ(turn.determinant(), 1.0);
  }
}

TEST(SensorGeometry, ComesOutOfItsParametersAsItWentIn) {
  for (const SensorGeometry& sensor : one_of_each()) {
    const SensorGeometry again =
        make_sensor(kind_of(sensor), columns_of(sensor), rows_of(sensor), parameters_of(sensor));
    EXPECT_EQ(again.index(), sensor.index());
    EXPECT_EQ(parameters_of(again), parameters_of(sensor));
    EXPECT_EQ(columns_of(with_raster(again, 5, 3)), 5);
    EXPECT_EQ(rows_of(with_raster(again, 5, 3)), 3);
  }
  EXPECT_THROW(make_sensor(SensorKind::Spherical, 8, 8, {1.0, 1.0, 0.1}), std::invalid_argument);
  EXPECT_THROW(make_sensor(static_cast<SensorKind>(3), 8, 8, {1.0, 1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace nextview
