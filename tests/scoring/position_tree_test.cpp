#include "scoring/position_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "scoring/surface_samples.h"
#include "scoring/visible_surface.h"
#include "tests/scoring/room_mesh.h"

namespace nextview {
namespace {

constexpr double kFar_m = std::numeric_limits<double>::infinity();

/// The plain twin: every position, one ray each.
bool any_sees(const Scene& scene, const std::vector<Eigen::Vector3d>& positions, double range_max_m,
              const Eigen::Vector3d& point_m) {
  return std::any_of(positions.begin(), positions.end(), [&](const Eigen::Vector3d& position) {
    return (position - point_m).norm() <= range_max_m && !hidden_by(scene, point_m, position);
  });
}

TEST(HiddenBy, NamesTheTriangleInTheWay) {
  TriangleMesh mesh;
  mesh.vertices_m = {{-1, -1, 1}, {1, -1, 1}, {0, 2, 1}};
  mesh.triangles = {{0, 1, 2}};
  const Scene scene(mesh);
  EXPECT_EQ(hidden_by(scene, {0, 0, 0}, {0, 0, 2}), 0u);
  EXPECT_EQ(hidden_by(scene, {0, 0, 2}, {0, 0, 0}), 0u) << "surfaces hide from both sides";
  EXPECT_EQ(hidden_by(scene, {0, 0, 0}, {0, 0, 0.9}), std::nullopt);
  EXPECT_EQ(hidden_by(scene, {0, 0, 0}, {5, 0, 2}), std::nullopt);
  EXPECT_EQ(hidden_by(scene, {0, 0, 1}, {0, 0, 2}), std::nullopt) << "its own points are seen";
}

TEST(PositionTree, SeesOverAWallOnlyFromHighEnough) {
  // A wall of 1 m between x = 2 and 2.1; the point lies on the floor 1 m behind it, so from 1 m
  // before it a position must be above 2.1 m.
  TriangleMesh mesh = room({6.0, 4.0, 4.0});
  add_box(mesh, {2.0, 0.0, 0.0}, {2.1, 4.0, 1.0});
  const Scene scene(mesh);
  const Eigen::Vector3d point(3.1, 2.0, 0.0);
  const TriangleNeighbours neighbours(scene.mesh());
  const auto sees = [&](double z) {
    return PositionTree(scene, neighbours, {{1.0, 2.0, z}, {1.0, 2.0, 1.0}}, kFar_m).sees(point);
  };
  EXPECT_FALSE(sees(1.8));
  EXPECT_TRUE(sees(2.2));
}

TEST(PositionTree, SeesNothingOutOfRange) {
  const Scene scene(room({6.0, 4.0, 4.0}));
  const TriangleNeighbours neighbours(scene.mesh());
  const std::vector<Eigen::Vector3d> positions = {{1.0, 2.0, 2.0}};
  EXPECT_TRUE(PositionTree(scene, neighbours, positions, 5.01).sees({6.0, 2.0, 2.0}));
  EXPECT_FALSE(PositionTree(scene, neighbours, positions, 4.99).sees({6.0, 2.0, 2.0}));
}

TEST(PositionTree, RefusesToBeEmpty) {
  const Scene scene(room({1.0, 1.0, 1.0}));
  const TriangleNeighbours neighbours(scene.mesh());
  EXPECT_THROW(PositionTree(scene, neighbours, {}, kFar_m), std::invalid_argument);
}

TEST(PositionTree, AgreesWithThePlainTwinOnRandomRooms) {
  int points = 0;
  int seen = 0;
  for (int world = 0; world < 40; ++world) {
    RandomStream random(world, 0, 0, RandomPurpose::InitialSimplex);
    const Eigen::Vector3d size(5.0, 4.0, 3.0);
    TriangleMesh mesh = room(size);
    for (int i = 0; i < 12; ++i) {  // furniture, some of it intersecting, flat or on the floor
      const Eigen::Vector3d a = random_point(random, Eigen::Vector3d::Zero(), size);
      Eigen::Vector3d b = random_point(random, Eigen::Vector3d::Zero(), size);
      if (i % 3 == 0) b.z() = 0.0;
      if (i % 4 == 0) b.x() = a.x();
      add_box(mesh, a.cwiseMin(b), a.cwiseMax(b));
    }
    for (int i = 0; i < 20; ++i) {  // loose triangles in any direction
      const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
      for (int corner = 0; corner < 3; ++corner) {
        mesh.vertices_m.push_back(
            random_point(random, Eigen::Vector3d::Zero(), size).cast<float>());
      }
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
    const Scene scene(mesh);
    std::vector<Eigen::Vector3d> positions;
    const int count = 1 + static_cast<int>(random.below(150));
    const Eigen::Vector3d corner = random_point(random, Eigen::Vector3d::Zero(), 0.7 * size);
    for (int i = 0; i < count; ++i) {
      positions.push_back(random_point(random, corner, corner + 0.3 * size));
    }
    const double range_max_m = world % 2 == 0 ? kFar_m : 2.0;
    const TriangleNeighbours neighbours(scene.mesh());
    PositionTree tree(scene, neighbours, positions, range_max_m);
    for (const Eigen::Vector3f& sample : sample_surface(mesh, 3.0)) {
      const Eigen::Vector3d point = sample.cast<double>();
      const bool expected = any_sees(scene, positions, range_max_m, point);
      ASSERT_EQ(tree.sees(point), expected) << "world " << world << ", " << point.transpose();
      ++points;
      seen += expected ? 1 : 0;
    }
  }
  RecordProperty("points", points);
  EXPECT_GT(points, 10000);
  EXPECT_GT(seen, points / 20);
  EXPECT_LT(seen, points * 19 / 20);
}

TEST(VisibleSurface, IsAllOfAnEmptyRoom) {
  const Eigen::Vector3d size(3.0, 2.0, 2.0);
  ReachParameters reach;
  reach.box_max_m = size;
  const VisibleSurface surface = visible_surface(Scene(room(size)), {1.5, 1.0, 1.0}, reach, 30.0);
  EXPECT_NEAR(surface.area_m2(), 32.0, 0.01);  // 2 (6 + 6 + 4) m2
  EXPECT_EQ(static_cast<std::int64_t>(surface.points_m.size()), surface.samples);
}

TEST(VisibleSurface, LeavesOutWhatABoxStandsOnAndTheBoxesUnderside) {
  const Eigen::Vector3d size(4.0, 4.0, 3.0);
  TriangleMesh mesh = room(size);
  add_box(mesh, {1.5, 1.5, 0.0}, {2.5, 2.5, 1.0});
  ReachParameters reach;
  reach.box_max_m = size;
  const VisibleSurface surface = visible_surface(Scene(mesh), {0.7, 0.7, 1.2}, reach, 30.0);
  EXPECT_NEAR(static_cast<double>(surface.samples) / VisibleSurface::kSamplesPerM2, 86.0, 0.01);
  // 80 m2 of room less the square metre under the box, and 5 m2 of box.
  EXPECT_NEAR(surface.area_m2(), 80.0 - 1.0 + 5.0, 0.1);
}

TEST(VisibleSurface, LeavesOutARoomNextDoor) {
  TriangleMesh mesh = room({3.0, 3.0, 3.0});
  add_box(mesh, {3.2, 0.0, 0.0}, {6.2, 3.0, 3.0});
  ReachParameters reach;
  reach.box_max_m = {6.2, 3.0, 3.0};
  const VisibleSurface surface = visible_surface(Scene(mesh), {1.5, 1.5, 1.5}, reach, 30.0);
  EXPECT_NEAR(surface.area_m2(), 54.0, 0.1);
}

}  // namespace
}  // namespace nextview
