#include "scene/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "scene/brute_force_scene.h"
#include "scene/scene_catalog.h"
#include "tests/scene/test_worlds.h"

namespace nextview {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Float and double see edges a little differently: a ray within this of an edge may pass in one and
// meet in the other, and is not compared.
constexpr double kEdge_m = 1e-5;

TriangleMesh own_room(const char* name) {
  const SceneDescription scene = find_scene(name, kScenesFolder);
  return load_mesh(scene.file, scene.options);
}

struct Counts {
  int met = 0;
  int missed = 0;
  int at_an_edge = 0;
};

// Whether rays beside this one all see the same; else it passes an edge.
bool away_from_edges(const BruteForceScene& scene, const Eigen::Vector3d& origin,
                     const Eigen::Vector3d& direction) {
  const auto hit = scene.first_hit(origin, direction);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-kEdge_m, kEdge_m}) {
      const auto beside = scene.first_hit(origin + side * Eigen::Vector3d::Unit(axis), direction);
      if (hit.has_value() != beside.has_value() ||
          (hit && std::abs(hit->distance_m - beside->distance_m) > 100 * kEdge_m)) {
        return false;
      }
    }
  }
  return true;
}

Counts compare_rays(const TriangleMesh& mesh, const Eigen::Vector3d& centre, double half_side,
                    int rays, int seed) {
  const Scene scene(mesh);
  const BruteForceScene plain(mesh);
  RandomStream random = random_stream(seed);
  Counts counts;
  for (int i = 0; i < rays; i += Scene::kPacketSize) {
    const Eigen::Vector3d origin =
        (centre + random_point(random, half_side)).cast<float>().cast<double>();
    std::vector<Scene::Directions> directions(1);
    std::vector<Scene::Distances> distances(1);
    for (std::size_t k = 0; k < Scene::kPacketSize; ++k) {
      const Eigen::Vector3f direction = random_direction(random).cast<float>();
      directions[0].x[k] = direction.x();
      directions[0].y[k] = direction.y();
      directions[0].z[k] = direction.z();
    }
    scene.cast(origin.cast<float>(), directions, distances);
    for (std::size_t k = 0; k < Scene::kPacketSize; ++k) {
      const Eigen::Vector3d direction(static_cast<double>(directions[0].x[k]),
                                      static_cast<double>(directions[0].y[k]),
                                      static_cast<double>(directions[0].z[k]));
      if (!away_from_edges(plain, origin, direction)) {
        ++counts.at_an_edge;
        continue;
      }
      const auto expected = plain.first_hit(origin, direction);
      const auto single = scene.first_hit(origin, direction);
      const auto packet_m = static_cast<double>(distances[0].m[k]);
      if (!expected) {
        EXPECT_EQ(packet_m, kInfinity);
        EXPECT_FALSE(single.has_value());
        ++counts.missed;
        continue;
      }
      EXPECT_NEAR(packet_m, expected->distance_m, 2e-4);
      if (!single) {
        ADD_FAILURE() << "a single ray missed what is " << expected->distance_m << " m away";
        continue;
      }
      EXPECT_NEAR(static_cast<double>(single->distance_m), expected->distance_m, 2e-4);
      ++counts.met;
    }
  }
  return counts;
}

TEST(Scene, RaysInTriangleSoupsMeetWhatBruteForceMeets) {
  Counts sum;
  for (int seed = 1; seed <= 5; ++seed) {
    RandomStream random = random_stream(seed);
    const Counts counts =
        compare_rays(triangle_soup(random, 400), Eigen::Vector3d::Zero(), 2.5, 2400, seed);
    sum.met += counts.met;
    sum.missed += counts.missed;
    sum.at_an_edge += counts.at_an_edge;
  }
  EXPECT_GT(sum.met, 4000);
  EXPECT_GT(sum.missed, 1000);
  EXPECT_LT(sum.at_an_edge, 240);
}

TEST(Scene, RaysInOurRoomsMeetWhatBruteForceMeets) {
  for (const char* name : {"boxes", "columns"}) {
    const TriangleMesh mesh = own_room(name);
    const Counts counts = compare_rays(mesh, mesh.bounds_m().center(), 1.4, 4000, 9);
    EXPECT_GT(counts.met, 3500) << name;
  }
}

// Our faces meet corner to corner and Embree is told to be robust: not even rays aimed at edges
// slip through.
TEST(Scene, NoRayEscapesThroughTheEdgesOfOurRooms) {
  for (const char* name : {"boxes", "columns"}) {
    const SceneDescription description = find_scene(name, kScenesFolder);
    const Scene scene(load_mesh(description.file, description.options));
    const Eigen::Vector3d start = description.start_m.value();
    RandomStream random = random_stream(3);
    int cast = 0;
    for (std::size_t i = 0; i < scene.mesh().triangles.size(); ++i) {
      for (int corner = 0; corner < 3; ++corner) {
        const Eigen::Vector3d a = scene.mesh().corner_m(i, corner);
        const Eigen::Vector3d b = scene.mesh().corner_m(i, (corner + 1) % 3);
        for (int k = 0; k < 200; ++k) {
          const Eigen::Vector3d target = a + random.uniform() * (b - a);
          EXPECT_TRUE(scene.first_hit(start, (target - start).normalized()).has_value())
              << name << " towards " << target.transpose();
          ++cast;
        }
      }
    }
    EXPECT_GT(cast, 40000) << name;
  }
}

TEST(Scene, ClearanceIsThatOfBruteForce) {
  RandomStream random = random_stream(5);
  int near = 0;
  int far = 0;
  int crossing = 0;
  for (int world = 0; world < 4; ++world) {
    const TriangleMesh mesh = triangle_soup(random, 150);
    const Scene scene(mesh);
    const BruteForceScene plain(mesh);
    for (int i = 0; i < 1000; ++i) {
      const Eigen::Vector3d a = random_point(random, 3.0);
      const double length = random.uniform() < 0.1 ? 0.0 : 3.0 * random.uniform();
      const Eigen::Vector3d b = a + length * random_direction(random);
      const double at_most = i % 3 == 0 ? kInfinity : 0.5 * random.uniform();
      const double expected = plain.clearance_m(a, b, at_most);
      EXPECT_NEAR(scene.clearance_m(a, b, at_most), expected, 1e-9);
      ++(expected == 0.0 ? crossing : expected < at_most ? near : far);
    }
  }
  EXPECT_GT(near, 500);
  EXPECT_GT(far, 500);
  EXPECT_GT(crossing, 200);
}

TEST(Scene, ClearanceInARoomWorkedByHand) {
  const Scene scene(load_mesh(kDataFolder / "room.obj"));
  EXPECT_DOUBLE_EQ(scene.clearance_m({0, 0, 0.7}, {0, 0, 0.7}, kInfinity), 0.7);
  EXPECT_DOUBLE_EQ(scene.clearance_m({0, 0, 0.7}, {1.5, 0, 0.7}, kInfinity), 0.5);
  EXPECT_DOUBLE_EQ(scene.clearance_m({0, 0, 0.7}, {1.5, 0, 0.7}, 0.2), 0.2);
  EXPECT_EQ(scene.clearance_m({0, 0, 0.7}, {3, 0, 0.7}, kInfinity), 0.0);
}

TEST(Scene, IsTheSameEveryTimeItIsBuilt) {
  const TriangleMesh mesh = own_room("boxes");
  const Scene one(mesh);
  const Scene other(mesh);
  RandomStream random = random_stream(6);
  int met = 0;
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d origin = mesh.bounds_m().center() + random_point(random, 1.4);
    const Eigen::Vector3d direction = random_direction(random);
    const auto a = one.first_hit(origin, direction);
    const auto b = other.first_hit(origin, direction);
    ASSERT_EQ(a.has_value(), b.has_value());
    if (a) {
      EXPECT_EQ(a->distance_m, b->distance_m);
      EXPECT_EQ(a->triangle, b->triangle);
      ++met;
    }
  }
  EXPECT_GT(met, 2700);
}

TEST(Scene, RefusesMeshesThatCannotBe) {
  const TriangleMesh mesh = load_mesh(kDataFolder / "triangle.ply");
  EXPECT_THROW(Scene(TriangleMesh{}), std::invalid_argument);
  TriangleMesh out_of_range = mesh;
  out_of_range.triangles[0][1] = 3;
  EXPECT_THROW(Scene{out_of_range}, std::invalid_argument);
  TriangleMesh not_finite = mesh;
  not_finite.vertices_m[0].x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(Scene{not_finite}, std::invalid_argument);
}

}  // namespace
}  // namespace nextview
