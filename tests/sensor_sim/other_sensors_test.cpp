// Scans of the sensors that are no tilted line scan.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "scene/brute_force_scene.h"
#include "scene/mesh_file.h"
#include "sensor_sim/scan.h"
#include "tests/scene/test_worlds.h"

namespace nextview {
namespace {

using std::numbers::pi;
const SphericalScanner kPanorama{36, 11, 2.0 * pi, pi * 5.0 / 9.0};

RangeImage scan_of(const Scene& scene, const SensorGeometry& sensor, const SensorPose& pose,
                   const RangeLimits& limits = {}) {
  RandomStream unused = random_stream(1);
  return scan(scene, make_ray_table(sensor), limits, pose, 0.0, unused, baseline_m_of(sensor));
}

float range_of_picture(const RangeImage& image, int u, int v) {
  return image.range_m[static_cast<std::size_t>(u * image.rays.columns() + v)];
}

// A room of 4 x 3 x 2 m: x in [-2, 2], y in [-1, 2], z in [0, 2].
TEST(OtherSensors, APanoramaOfABoxRoomWorkedByHand) {
  const Scene scene(load_mesh(kDataFolder / "room.obj"));
  // Four columns a quarter turn apart, the first of them 135 degrees to the left.
  const SphericalScanner sensor{4, 3, 2.0 * pi, pi / 2.0};
  // Turned by 45 degrees to the right, they look left, ahead, right and back.
  const SensorPose pose{{0.5, 0.0, 1.2}, -pi / 4.0, 0.0};
  const RangeImage image = scan_of(scene, sensor, pose);
  EXPECT_FLOAT_EQ(range_of_picture(image, 0, 1), 2.5F);  // left: 90 degrees
  EXPECT_FLOAT_EQ(range_of_picture(image, 1, 1), 2.0F);  // ahead
  EXPECT_FLOAT_EQ(range_of_picture(image, 2, 1), 1.5F);  // right
  EXPECT_FLOAT_EQ(range_of_picture(image, 3, 1), 1.0F);  // back
  // 45 degrees up the ceiling is 0.8 sqrt 2 away, down the floor is 1.2 sqrt 2, but a wall may be
  // nearer.
  EXPECT_FLOAT_EQ(range_of_picture(image, 1, 0), quantise_range(0.8 * std::sqrt(2.0)));
  EXPECT_FLOAT_EQ(range_of_picture(image, 1, 2), quantise_range(1.2 * std::sqrt(2.0)));
  EXPECT_FLOAT_EQ(range_of_picture(image, 3, 2), quantise_range(1.0 * std::sqrt(2.0)));
}

TEST(OtherSensors, EveryRangeIsThatOfEveryTriangle) {
  RandomStream random = random_stream(3);
  int compared = 0;
  int different = 0;  // where a ray passes the rim of a triangle
  for (int n = 0; n < 20; ++n) {
    const TriangleMesh mesh = triangle_soup(random, 40);
    const Scene scene(mesh);
    const BruteForceScene plain(mesh);
    const SensorPose pose{random_point(random, 0.5), 6.0 * random.uniform(),
                          pi * (random.uniform() - 0.5)};
    const LineStriper striper{9, 14, 2.0, 1.2, 0.0};
    for (const SensorGeometry& sensor : {SensorGeometry(kPanorama), SensorGeometry(striper)}) {
      const RangeImage image = scan_of(scene, sensor, pose, {0.0, 100.0});
      for (int v = 0; v < image.rays.rows(); ++v) {
        for (int u = 0; u < image.rays.columns(); ++u) {
          const auto hit =
              plain.first_hit(pose.position_m, image.world_from_sensor * image.rays.ray(u, v));
          const float range_m =
              image.range_m[static_cast<std::size_t>(v * image.rays.columns() + u)];
          if (!hit || !std::isfinite(range_m)) {
            different += hit.has_value() != std::isfinite(range_m);
            continue;
          }
          different += std::abs(range_m - hit->distance_m) > 1e-3;
          ++compared;
        }
      }
    }
  }
  EXPECT_GT(compared, 1000);
  EXPECT_LE(different, 3);
}

// A post of 0.2 x 0.2 m, 1 m ahead, before a wall at 2 m.
TriangleMesh post_before_wall() {
  TriangleMesh mesh;
  const auto quad = [&mesh](const std::array<Eigen::Vector3f, 4>& corners) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
    mesh.vertices_m.insert(mesh.vertices_m.end(), corners.begin(), corners.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  };
  quad({Eigen::Vector3f(-5, 2, -5), {5, 2, -5}, {5, 2, 5}, {-5, 2, 5}});
  quad({Eigen::Vector3f(-0.1F, 1, -5), {0.1F, 1, -5}, {0.1F, 1, 5}, {-0.1F, 1, 5}});
  return mesh;
}

// From a camera at x = b the post hides the wall at y = 2 where x is between -0.2 - b and 0.2 - b;
// the light itself does not reach it between -0.2 and 0.2.
TEST(OtherSensors, ACameraDoesNotSeeWhatIsLitBehindACorner) {
  const Scene scene(post_before_wall());
  const double baseline_m = 0.25;
  const LineStriper sensor{401, 5, 1.0, 0.4, baseline_m};
  const RangeImage image = scan_of(scene, sensor, {{0, 0, 0}, 0.0, 0.0});
  int hidden = 0;
  for (int u = 0; u < 401; ++u) {
    for (int v = 0; v < 5; ++v) {
      const float range_m = range_of_picture(image, u, v);
      const Eigen::Vector3d ray = image.rays.ray(v, u);
      const double at_wall_x = 2.0 * ray.x() / ray.y();
      if (std::abs(std::abs(at_wall_x) - 0.2) < 0.01) continue;     // an edge of the post
      if (std::abs(at_wall_x + 0.2 + baseline_m) < 0.01) continue;  // of its shadow
      const bool is_hidden = at_wall_x > -0.2 - baseline_m && at_wall_x < -0.2;
      EXPECT_EQ(std::isnan(range_m), is_hidden) << u << ", " << v << ": " << range_m;
      hidden += is_hidden;
      if (is_hidden) continue;
      const double depth_m = std::abs(at_wall_x) < 0.2 ? 1.0 : 2.0;
      EXPECT_NEAR(range_m * ray.y(), depth_m, 1e-3);
    }
  }
  EXPECT_GT(hidden, 100);
  LineStriper without = sensor;
  without.baseline_m = 0.0;
  for (const float range_m : scan_of(scene, without, {{0, 0, 0}, 0.0, 0.0}).range_m) {
    EXPECT_TRUE(std::isfinite(range_m));
  }
}

}  // namespace
}  // namespace nextview
