#include "sensor_sim/scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "scene/brute_force_scene.h"
#include "scene/mesh_file.h"
#include "sensor_sim/measured_range.h"
#include "tests/scene/test_worlds.h"

namespace nextview {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr float kNoReturn = std::numeric_limits<float>::infinity();

// A room of 4 x 3 x 2 m: x in [-2, 2], y in [-1, 2], z in [0, 2].
Scene room() { return Scene(load_mesh(kDataFolder / "room.obj")); }

RayTable small_sensor() { return make_ray_table(TiltedLineScan::with_aperture(5, 3, kPi / 3.0)); }

RangeImage scan_without_noise(const Scene& scene, const RayTable& rays, const SensorPose& pose,
                              const RangeLimits& limits = {}) {
  RandomStream unused = random_stream(1);
  return scan(scene, rays, limits, pose, 0.0, unused);
}

float range_at(const RangeImage& image, int u, int v) {
  return image.range_m[static_cast<std::size_t>(v * image.rays.columns() + u)];
}

TEST(Scan, RangesInABoxRoomWorkedByHand) {
  const Scene scene = room();
  // From (0, 0, 1) along +y the back wall is 2 m away; 30 degrees to either side, 2 / cos 30.
  const RangeImage image = scan_without_noise(scene, small_sensor(), {{0, 0, 1}, 0.0, 0.0});
  EXPECT_FLOAT_EQ(range_at(image, 2, 1), 2.0F);
  EXPECT_FLOAT_EQ(range_at(image, 0, 1), 2.3094F);
  EXPECT_FLOAT_EQ(range_at(image, 4, 1), 2.3094F);
  // Up by beta/2 the wall is 2 / cos(beta/2) away, at 1 + 2 tan(beta/2) = 1.55 m: below the
  // ceiling.
  const double half_beta = 0.5 * std::atan(3.0 / 5.0 * std::tan(kPi / 3.0));
  EXPECT_FLOAT_EQ(range_at(image, 2, 0), quantise_range(2.0 / std::cos(half_beta)));
  EXPECT_FLOAT_EQ(range_at(image, 2, 2), range_at(image, 2, 0));
}

TEST(Scan, PanTurnsLeftAndTiltLooksUp) {
  const Scene scene = room();
  const Eigen::Vector3d position(0.5, 0.0, 0.8);
  const auto middle_range = [&](double pan_rad, double tilt_rad) {
    return range_at(scan_without_noise(scene, small_sensor(), {position, pan_rad, tilt_rad}), 2, 1);
  };
  EXPECT_FLOAT_EQ(middle_range(kPi / 2.0, 0.0), 2.5F);   // left: the wall at x = -2
  EXPECT_FLOAT_EQ(middle_range(-kPi / 2.0, 0.0), 1.5F);  // right: x = 2
  EXPECT_FLOAT_EQ(middle_range(kPi, 0.0), 1.0F);         // behind: y = -1
  EXPECT_FLOAT_EQ(middle_range(0.3, kPi / 2.0), 1.2F);   // up: z = 2
  EXPECT_FLOAT_EQ(middle_range(0.3, -kPi / 2.0), 0.8F);  // down: z = 0
}

TEST(Scan, DescribesItself) {
  const Scene scene = room();
  const SensorPose pose{{0.1, 0.2, 1.0}, 0.4, -0.2};
  const RangeLimits limits{0.1, 8.0};
  const RangeImage image = scan_without_noise(scene, small_sensor(), pose, limits);
  EXPECT_EQ(image.position_m, pose.position_m);
  EXPECT_EQ(image.pose.pan_rad, 0.4);
  EXPECT_EQ(image.pose.tilt_rad, -0.2);
  EXPECT_EQ(image.world_from_sensor, world_from_sensor_rotation(0.4, -0.2));
  EXPECT_EQ(image.rays.columns(), 5);
  EXPECT_EQ(image.rays.rows(), 3);
  EXPECT_EQ(image.limits.min_m, 0.1);
  EXPECT_EQ(image.limits.max_m, 8.0);
  EXPECT_EQ(image.range_m.size(), 15U);
}

// Rasters that do and do not fill whole tiles of pixels, from poses all over the room.
TEST(Scan, EveryPixelIsThatOfBruteForce) {
  const TriangleMesh mesh = load_mesh(kDataFolder / "room.obj");
  const Scene scene(mesh);
  const BruteForceScene plain(mesh);
  RandomStream random = random_stream(2);
  int pixels = 0;
  for (const auto& [columns, rows] : {std::pair{8, 4}, {7, 5}, {2, 2}, {3, 9}, {64, 30}}) {
    const RayTable rays = make_ray_table(TiltedLineScan::with_aperture(columns, rows, 1.0));
    for (int i = 0; i < 10; ++i) {
      const SensorPose pose{Eigen::Vector3d(0, 0.5, 1) + random_point(random, 0.9),
                            2.0 * kPi * random.uniform(), kPi * (random.uniform() - 0.5)};
      const RangeImage image = scan_without_noise(scene, rays, pose);
      for (int v = 0; v < rows; ++v) {
        for (int u = 0; u < columns; ++u) {
          const Eigen::Vector3d direction = image.world_from_sensor * rays.ray(u, v);
          const auto hit = plain.first_hit(pose.position_m, direction);
          ASSERT_TRUE(hit.has_value());
          EXPECT_NEAR(range_at(image, u, v), hit->distance_m, 1.1e-4) << u << ", " << v;
          ++pixels;
        }
      }
    }
  }
  EXPECT_EQ(pixels, 10 * (8 * 4 + 7 * 5 + 2 * 2 + 3 * 9 + 64 * 30));
}

// What scan() should measure, to the last bit, worked out one pixel after the other in tiles of
// 4 x 4: the rays by eq. 1 and 5, their packets cast one by one, measured_range.
std::vector<float> plain_ranges(const Scene& scene, const RayTable& rays, const RangeLimits& limits,
                                const SensorPose& pose) {
  const Eigen::Matrix3d rotation = world_from_sensor_rotation(pose.pan_rad, pose.tilt_rad);
  std::vector<float> range_m(rays.pixels());
  for (int v0 = 0; v0 < rays.rows(); v0 += 4) {
    for (int u0 = 0; u0 < rays.columns(); u0 += 4) {
      Scene::Directions directions;
      Scene::Distances distances;
      for (int i = 0; i < 16; ++i) {
        const auto u = static_cast<std::size_t>(std::min(u0 + i % 4, rays.columns() - 1));
        const auto v = static_cast<std::size_t>(std::min(v0 + i / 4, rays.rows() - 1));
        const Eigen::Vector3d row_axis =
            rays.row_cos[v] * rotation.col(1) + rays.row_sin[v] * rotation.col(2);
        const Eigen::Vector3d direction =
            rays.column_cos[u] * row_axis - rays.column_sin[u] * rotation.col(0);
        const auto lane = static_cast<std::size_t>(i);
        directions.x[lane] = static_cast<float>(direction.x());
        directions.y[lane] = static_cast<float>(direction.y());
        directions.z[lane] = static_cast<float>(direction.z());
      }
      scene.cast(pose.position_m.cast<float>(), {&directions, 1}, {&distances, 1});
      for (int i = 0; i < 16; ++i) {
        const int u = u0 + i % 4;
        const int v = v0 + i / 4;
        if (u < rays.columns() && v < rays.rows()) {
          range_m[static_cast<std::size_t>(v * rays.columns() + u)] =
              measured_range(static_cast<double>(distances.m[static_cast<std::size_t>(i)]), limits);
        }
      }
    }
  }
  return range_m;
}

TEST(Scan, EveryPixelIsThePlainOneToTheLastBit) {
  const Scene scene = room();
  RandomStream random = random_stream(8);
  int pixels = 0;
  for (const auto& [columns, rows] :
       {std::pair{8, 4}, {7, 5}, {2, 2}, {3, 9}, {64, 30}, {2, 301}, {301, 2}, {121, 79}}) {
    const RayTable rays = make_ray_table(TiltedLineScan::with_aperture(columns, rows, 1.0));
    for (int i = 0; i < 40; ++i) {
      const SensorPose pose{Eigen::Vector3d(0, 0.5, 1) + random_point(random, 0.9),
                            2.0 * kPi * random.uniform(), kPi * (random.uniform() - 0.5)};
      const RangeLimits limits{0.3, 1.5};
      const std::vector<float> range_m = scan_without_noise(scene, rays, pose, limits).range_m;
      const std::vector<float> plain_m = plain_ranges(scene, rays, limits, pose);
      ASSERT_EQ(range_m.size(), plain_m.size());
      EXPECT_EQ(std::memcmp(range_m.data(), plain_m.data(), range_m.size() * sizeof(float)), 0)
          << columns << " x " << rows << ", pose " << i;
      pixels += static_cast<int>(range_m.size());
    }
  }
  EXPECT_EQ(pixels, 40 * (8 * 4 + 7 * 5 + 2 * 2 + 3 * 9 + 64 * 30 + 4 * 301 + 121 * 79));
}

TEST(Scan, TooNearIsInvalidAndTooFarIsNoReturn) {
  const Scene scene = room();
  const SensorPose pose{{0, 0, 1}, 0.0, 0.0};
  const RangeImage image = scan_without_noise(scene, small_sensor(), pose, {2.05, 2.2});
  EXPECT_TRUE(std::isnan(range_at(image, 2, 1)));                                      // 2.0
  EXPECT_EQ(range_at(image, 0, 1), kNoReturn);                                         // 2.3094
  EXPECT_FLOAT_EQ(range_at(image, 1, 1), quantise_range(2.0 / std::cos(kPi / 12.0)));  // 2.0706
}

TEST(Scan, NothingMetIsNoReturnAndNotInvalid) {
  const Scene scene(load_mesh(kDataFolder / "triangle.ply"));
  const RangeImage image = scan_without_noise(scene, small_sensor(), {{0, -9, 0}, kPi, 0.0});
  for (const float range_m : image.range_m) {
    EXPECT_EQ(range_m, kNoReturn);
  }
}

TEST(Scan, WindingDuplicatesAndTrianglesOfNoAreaAreOfNoConsequence) {
  const Scene tidy = room();
  const Scene untidy(load_mesh(kDataFolder / "untidy_room.obj"));
  const RayTable rays = make_ray_table(TiltedLineScan::paper());
  RandomStream random = random_stream(3);
  for (int i = 0; i < 20; ++i) {
    const SensorPose pose{Eigen::Vector3d(0, 0.5, 1) + random_point(random, 0.9),
                          2.0 * kPi * random.uniform(), kPi * (random.uniform() - 0.5)};
    const RangeImage expected = scan_without_noise(tidy, rays, pose);
    const RangeImage image = scan_without_noise(untidy, rays, pose);
    for (std::size_t k = 0; k < expected.range_m.size(); ++k) {
      // Another diagonal through a face may round one step of 0.1 mm differently.
      EXPECT_NEAR(image.range_m[k], expected.range_m[k], 1.1e-4F);
    }
  }
}

TEST(Scan, NoiseIsSeededAndHasTheAskedDeviation) {
  const Scene scene = room();
  const RayTable rays = make_ray_table(TiltedLineScan::with_aperture(200, 100, kPi / 3.0));
  const SensorPose pose{{0, 0, 1}, 0.2, 0.1};
  const auto noisy = [&](int seed) {
    RandomStream noise = random_stream(seed);
    return scan(scene, rays, {}, pose, 0.02, noise).range_m;
  };
  const std::vector<float> clean = scan_without_noise(scene, rays, pose).range_m;
  const std::vector<float> one = noisy(1);
  EXPECT_EQ(one, noisy(1));
  EXPECT_NE(one, noisy(2));
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < clean.size(); ++i) {
    const double error = static_cast<double>(one[i]) - static_cast<double>(clean[i]);
    sum += error;
    squares += error * error;
  }
  const auto count = static_cast<double>(clean.size());
  EXPECT_NEAR(sum / count, 0.0, 0.0008);  // 20 000 pixels: five standard deviations
  EXPECT_NEAR(std::sqrt(squares / count), 0.02, 0.0006);
}

// The noise of a pixel does not depend on what other pixels meet.
TEST(Scan, EveryPixelDrawsItsOwnNoise) {
  const Scene scene = room();
  RandomStream one = random_stream(4);
  RandomStream other = random_stream(4);
  const SensorPose pose{{0, 0, 1}, 0.0, 0.0};
  const RangeImage all = scan(scene, small_sensor(), {0.05, 30.0}, pose, 0.001, one);
  const RangeImage some = scan(scene, small_sensor(), {2.05, 30.0}, pose, 0.001, other);
  EXPECT_TRUE(std::isnan(range_at(some, 2, 1)));
  EXPECT_EQ(range_at(some, 4, 2), range_at(all, 4, 2));
}

TEST(Scan, NoiseMayCarryARangeOverALimit) {
  const Scene scene = room();
  const RayTable rays = make_ray_table(TiltedLineScan::with_aperture(100, 100, 0.01));
  RandomStream noise = random_stream(5);
  const RangeImage image = scan(scene, rays, {1.99, 2.01}, {{0, 0, 1}, 0, 0}, 0.01, noise);
  int invalid = 0;
  int no_return = 0;
  for (const float range_m : image.range_m) {
    invalid += std::isnan(range_m) ? 1 : 0;
    no_return += range_m == kNoReturn ? 1 : 0;
    if (std::isfinite(range_m)) {
      EXPECT_GE(range_m, 1.99F);
      EXPECT_LE(range_m, 2.01F);
    }
  }
  EXPECT_NEAR(invalid, 1587, 200);  // the tails beyond one standard deviation
  EXPECT_NEAR(no_return, 1587, 200);
}

TEST(Scan, RangesAreMultiplesOfATenthOfAMillimetre) {
  const Scene scene = room();
  RandomStream noise = random_stream(6);
  const RangeImage image =
      scan(scene, make_ray_table(TiltedLineScan::paper()), {}, {{0, 0, 1}, 0.3, 0.1}, 0.01, noise);
  for (const float range_m : image.range_m) {
    EXPECT_EQ(quantise_range(static_cast<double>(range_m)), range_m);
  }
}

TEST(Scan, RefusesWhatCannotBe) {
  const Scene scene = room();
  const RayTable rays = small_sensor();
  const SensorPose pose{{0, 0, 1}, 0.0, 0.0};
  RandomStream noise = random_stream(1);
  const double nan = std::nan("");
  EXPECT_THROW(scan(scene, RayTable{}, {}, pose, 0.0, noise), std::invalid_argument);
  EXPECT_THROW(scan(scene, rays, {-0.1, 30.0}, pose, 0.0, noise), std::invalid_argument);
  EXPECT_THROW(scan(scene, rays, {2.0, 1.0}, pose, 0.0, noise), std::invalid_argument);
  EXPECT_THROW(scan(scene, rays, {0.1, HUGE_VAL}, pose, 0.0, noise), std::invalid_argument);
  EXPECT_THROW(scan(scene, rays, {}, pose, -0.1, noise), std::invalid_argument);
  EXPECT_THROW(scan(scene, rays, {}, {{0, nan, 1}, 0, 0}, 0.0, noise), std::invalid_argument);
  EXPECT_THROW(scan(scene, rays, {}, {{0, 0, 1}, nan, 0}, 0.0, noise), std::invalid_argument);
}

}  // namespace
}  // namespace nextview
