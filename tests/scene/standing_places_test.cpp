#include "scene/standing_places.h"

#include <gtest/gtest.h>

#include "scene/mesh_file.h"
#include "scene/scene_catalog.h"
#include "tests/scene/test_worlds.h"

namespace nextview {
namespace {

/// The six sides of a box, seen from both.
void add_box(TriangleMesh& mesh, const Eigen::Vector3f& min, const Eigen::Vector3f& max) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
  for (int corner = 0; corner < 8; ++corner) {
    mesh.vertices_m.emplace_back(corner & 1 ? max.x() : min.x(), corner & 2 ? max.y() : min.y(),
                                 corner & 4 ? max.z() : min.z());
  }
  constexpr std::uint32_t kSides[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                          {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
  for (const auto& side : kSides) {
    mesh.triangles.push_back({first + side[0], first + side[1], first + side[2]});
    mesh.triangles.push_back({first + side[0], first + side[2], first + side[3]});
  }
}

TEST(StandingPlaces, AreAboveTheFloorAndClearOfEverything) {
  TriangleMesh mesh;
  add_box(mesh, {0.0F, 0.0F, -1.0F}, {6.0F, 5.0F, 1.8F});
  add_box(mesh, {2.0F, 1.0F, -1.0F}, {3.0F, 4.0F, 0.5F});
  const Scene scene(mesh);
  const StandingParameters parameters;
  const auto places = standing_places(scene, parameters, 100);
  ASSERT_GE(places.size(), 4U);
  for (const Eigen::Vector3d& place : places) {
    EXPECT_NEAR(place.z(), 0.2, 1e-5) << place.transpose();  // on the box the ceiling is too near
    EXPECT_GE(scene.clearance_m(place, place, 1.0), parameters.clearance_m);
    for (const Eigen::Vector3d& other : places) {
      EXPECT_TRUE(&place == &other || (place - other).norm() >= 1.5);
    }
  }
}

TEST(StandingPlaces, AreInTheRoomThatShowsMostAndNotOutside) {
  TriangleMesh mesh;
  add_box(mesh, {0.0F, 0.0F, 0.0F}, {2.0F, 4.0F, 2.8F});
  add_box(mesh, {2.1F, 0.0F, 0.0F}, {8.0F, 4.0F, 2.8F});
  // The ground they stand on.
  mesh.vertices_m.insert(mesh.vertices_m.end(),
                         {{-9.0F, -9.0F, -0.1F}, {19.0F, -9.0F, -0.1F}, {0.0F, 25.0F, -0.1F}});
  const auto count = static_cast<std::uint32_t>(mesh.vertices_m.size());
  mesh.triangles.push_back({count - 3, count - 2, count - 1});
  const auto places = standing_places(Scene(mesh), {}, 3);
  ASSERT_EQ(places.size(), 3U);
  for (const Eigen::Vector3d& place : places) {
    EXPECT_GT(place.x(), 2.1);
    EXPECT_LT(place.x(), 8.0);
    EXPECT_NEAR(place.z(), 1.2, 1e-5);
  }
}

TEST(StandingPlaces, AreThoseOfEveryStorey) {
  TriangleMesh mesh;
  add_box(mesh, {0.0F, 0.0F, 0.0F}, {3.0F, 3.0F, 2.5F});
  add_box(mesh, {0.0F, 0.0F, 2.7F}, {3.0F, 3.0F, 5.2F});
  const auto places = standing_places(Scene(mesh), {}, 2);
  ASSERT_EQ(places.size(), 2U);
  EXPECT_NEAR(std::min(places[0].z(), places[1].z()), 1.2, 1e-5);
  EXPECT_NEAR(std::max(places[0].z(), places[1].z()), 3.9, 1e-5);
}

TEST(StandingPlaces, AreNowhereWhereNobodyFits) {
  TriangleMesh mesh;
  add_box(mesh, {0.0F, 0.0F, 0.0F}, {3.0F, 3.0F, 1.5F});
  EXPECT_TRUE(standing_places(Scene(mesh), {}, 3).empty());
}

}  // namespace
}  // namespace nextview
