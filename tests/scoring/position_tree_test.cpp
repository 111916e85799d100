#include "scoring/position_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "scoring/surface_samples.h"
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

bool sees_from(const Scene& scene, const std::vector<Eigen::Vector3d>& positions,
               double range_max_m, const Eigen::Vector3d& point_m) {
  const TriangleNeighbours neighbours(scene.mesh());
  const PositionTree tree(positions);
  return PositionSearch(scene, neighbours, tree, range_max_m).sees(point_m);
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

TEST(ClearlyHides, IsNeverTrueWhereARayPasses) {
  RandomStream random(1, 0, 0, RandomPurpose::InitialSimplex);
  int hidden = 0;
  int clearly = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto at = [&] { return random_point(random, {-2, -2, -2}, {2, 2, 2}); };
    TriangleMesh mesh;
    for (int corner = 0; corner < 3; ++corner) mesh.vertices_m.push_back(at().cast<float>());
    mesh.triangles = {{0, 1, 2}};
    const Scene scene(mesh);
    for (int ray = 0; ray < 20; ++ray) {
      // Half of the points on the triangle or near to it, where it is least clear.
      const bool near = ray % 2 == 0;
      const Eigen::Vector3d on =
          0.5 * (mesh.corner_m(0, 0) + mesh.corner_m(0, 1)) +
          0.5 * random.uniform() * (mesh.corner_m(0, 2) - mesh.corner_m(0, 0));
      const Eigen::Vector3d point =
          (near ? Eigen::Vector3d(on + 0.002 * at()) : at()).cast<float>().cast<double>();
      const Eigen::Vector3d position = at();
      const bool is_hidden = hidden_by(scene, point, position).has_value();
      const bool is_clear = clearly_hides(mesh, 0, point, position);
      ASSERT_TRUE(is_hidden || !is_clear) << i << ": " << point.transpose();
      hidden += is_hidden ? 1 : 0;
      clearly += is_clear ? 1 : 0;
    }
  }
  EXPECT_GT(hidden, 2000);
  EXPECT_GT(clearly, hidden * 9 / 10) << "of " << hidden;
}

TEST(ClearlyHides, LeavesTheEdgesToARay) {
  TriangleMesh mesh;
  mesh.vertices_m = {{-1, -1, 1}, {1, -1, 1}, {0, 2, 1}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_TRUE(clearly_hides(mesh, 0, {0, 0, 0}, {0, 0, 2}));
  EXPECT_TRUE(clearly_hides(mesh, 0, {0, 0, 2}, {0, 0, 0})) << "from both sides";
  EXPECT_FALSE(clearly_hides(mesh, 0, {0, 0, 0}, {0, 0, 0.9})) << "behind the position";
  EXPECT_FALSE(clearly_hides(mesh, 0, {0, 0, 0}, {0, -1.99999, 2})) << "on the edge";
  EXPECT_TRUE(clearly_hides(mesh, 0, {0, 0, 0}, {0, -1.99, 2}));
  EXPECT_FALSE(clearly_hides(mesh, 0, {0, 0, 1}, {0, 0, 2})) << "its own points";
  EXPECT_FALSE(clearly_hides(mesh, 0, {0, 0.5, 1}, {0, 0, 1})) << "seen edge-on";
}

TEST(PositionSearch, SeesOverAWallOnlyFromHighEnough) {
  // A wall of 1 m between x = 2 and 2.1; the point lies on the floor 1 m behind it, so from 1 m
  // before it a position must be above 2.1 m.
  TriangleMesh mesh = room({6.0, 4.0, 4.0});
  add_box(mesh, {2.0, 0.0, 0.0}, {2.1, 4.0, 1.0});
  const Scene scene(mesh);
  const Eigen::Vector3d point(3.1, 2.0, 0.0);
  const auto sees = [&](double z) {
    return sees_from(scene, {{1.0, 2.0, z}, {1.0, 2.0, 1.0}}, kFar_m, point);
  };
  EXPECT_FALSE(sees(1.8));
  EXPECT_TRUE(sees(2.2));
}

TEST(PositionSearch, SeesNothingOutOfRange) {
  const Scene scene(room({6.0, 4.0, 4.0}));
  EXPECT_TRUE(sees_from(scene, {{1.0, 2.0, 2.0}}, 5.01, {6.0, 2.0, 2.0}));
  EXPECT_FALSE(sees_from(scene, {{1.0, 2.0, 2.0}}, 4.99, {6.0, 2.0, 2.0}));
}

TEST(PositionTree, RefusesToBeEmpty) { EXPECT_THROW(PositionTree({}), std::invalid_argument); }

/// A room with furniture, some of it intersecting, flat or on the floor, and loose triangles.
TriangleMesh furnished_room(RandomStream& random, const Eigen::Vector3d& size) {
  TriangleMesh mesh = room(size);
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector3d a = random_point(random, Eigen::Vector3d::Zero(), size);
    Eigen::Vector3d b = random_point(random, Eigen::Vector3d::Zero(), size);
    if (i % 3 == 0) b.z() = 0.0;
    if (i % 4 == 0) b.x() = a.x();
    add_box(mesh, a.cwiseMin(b), a.cwiseMax(b));
  }
  for (int i = 0; i < 20; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
    for (int corner = 0; corner < 3; ++corner) {
      mesh.vertices_m.push_back(random_point(random, Eigen::Vector3d::Zero(), size).cast<float>());
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

TEST(PositionSearch, AgreesWithThePlainTwinOnRandomRooms) {
  int points = 0;
  int seen = 0;
  for (int world = 0; world < 40; ++world) {
    RandomStream random(world, 0, 0, RandomPurpose::InitialSimplex);
    const Eigen::Vector3d size(5.0, 4.0, 3.0);
    const Scene scene(furnished_room(random, size));
    std::vector<Eigen::Vector3d> positions;
    const int count = 1 + static_cast<int>(random.below(150));
    const Eigen::Vector3d corner = random_point(random, Eigen::Vector3d::Zero(), 0.7 * size);
    for (int i = 0; i < count; ++i) {
      positions.push_back(random_point(random, corner, corner + 0.3 * size));
    }
    const double range_max_m = world % 2 == 0 ? kFar_m : 2.0;
    const TriangleNeighbours neighbours(scene.mesh());
    const PositionTree tree(positions);
    PositionSearch search(scene, neighbours, tree, range_max_m);
    for (const Eigen::Vector3f& sample : sample_surface(scene.mesh(), 3.0)) {
      const Eigen::Vector3d point = sample.cast<double>();
      const bool expected = any_sees(scene, positions, range_max_m, point);
      ASSERT_EQ(search.sees(point), expected) << "world " << world << ", " << point.transpose();
      ++points;
      seen += expected ? 1 : 0;
    }
  }
  RecordProperty("points", points);
  EXPECT_GT(points, 10000);
  EXPECT_GT(seen, points / 20);
  EXPECT_LT(seen, points * 19 / 20);
}

/// A closed house of two rooms with a wall of thick blocks, windows and panes before them; all on a
/// raster of 0.1 m like the positions, so that surfaces meet without sharing edges, rays run along
/// them, and positions lie exactly behind edges.
TriangleMesh house_on_a_raster(RandomStream& random) {
  TriangleMesh mesh = room({8.0, 5.0, 2.5});
  const auto raster = [&](int least, int most) {
    return 0.1 * (least + static_cast<int>(random.below(static_cast<std::uint32_t>(most - least))));
  };
  const double wall = raster(35, 45);
  for (double y = 0.0; y < 4.95; y += 0.5) {
    const double bottom = random.below(4) == 0 ? raster(2, 12) : 0.0;
    const double top = random.below(3) == 0 ? raster(12, 24) : 2.5;
    add_box(mesh, {wall, y, bottom}, {wall + 0.2, y + 0.5, top});
    if (random.below(4) == 0) continue;
    const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
    const double pane = wall + (random.below(2) == 0 ? 0.2 : 0.25);
    for (const auto& [at_y, at_z] : {std::pair(y, 0.0), {y + 0.5, 0.0}, {y + 0.5, 2.5}, {y, 2.5}}) {
      mesh.vertices_m.push_back(Eigen::Vector3d(pane, at_y, at_z).cast<float>());
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  for (int i = 0; i < 4; ++i) {
    const double x = raster(48, 70);
    const double y = raster(0, 40);
    add_box(mesh, {x, y, 0.0}, {x + 0.4, y + raster(2, 10), raster(3, 20)});
  }
  return mesh;
}

TEST(PositionSearch, AgreesWithThePlainTwinInHousesOnTheRasterOfThePositions) {
  int points = 0;
  int seen = 0;
  for (int world = 0; world < 12; ++world) {
    RandomStream random(world, 0, 0, RandomPurpose::InitialSimplex);
    const Scene scene(house_on_a_raster(random));
    std::vector<Eigen::Vector3d> positions;
    for (int x = 5; x < 31; x += 2) {
      for (int y = 5; y < 46; y += 2) {
        for (int z = 5; z < 20; z += 2) positions.push_back(0.1 * Eigen::Vector3d(x, y, z));
      }
    }
    const TriangleNeighbours neighbours(scene.mesh());
    const PositionTree tree(positions);
    PositionSearch search(scene, neighbours, tree, kFar_m);
    for (const Eigen::Vector3f& sample : sample_surface(scene.mesh(), 4.0)) {
      const Eigen::Vector3d point = sample.cast<double>();
      const bool expected = any_sees(scene, positions, kFar_m, point);
      ASSERT_EQ(search.sees(point), expected) << "world " << world << ", " << point.transpose();
      ++points;
      seen += expected ? 1 : 0;
    }
  }
  RecordProperty("points", points);
  EXPECT_GT(points, 5000);
  EXPECT_GT(seen, points / 4);
  EXPECT_LT(seen, points * 3 / 4);
}

}  // namespace
}  // namespace nextview
