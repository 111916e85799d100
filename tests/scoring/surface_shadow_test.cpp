#include "scoring/surface_shadow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scoring/position_tree.h"
#include "tests/scoring/room_mesh.h"

namespace nextview {
namespace {

// A square of 2 m at z = 1 around the z axis, in n x n small squares of two triangles each, every
// triangle with vertices of its own. Those that `keep` refuses are left out.
template <class Keep>
TriangleMesh square(int n, const Keep& keep) {
  TriangleMesh mesh;
  const auto at = [n](int i) {
    return 2.0F * static_cast<float>(i) / static_cast<float>(n) - 1.0F;
  };
  const auto add = [&mesh](const Eigen::Vector2f& a, const Eigen::Vector2f& b,
                           const Eigen::Vector2f& c) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
    for (const Eigen::Vector2f& corner : {a, b, c}) {
      mesh.vertices_m.emplace_back(corner.x(), corner.y(), 1.0F);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      if (!keep(i, j)) continue;
      add({at(i), at(j)}, {at(i + 1), at(j)}, {at(i + 1), at(j + 1)});
      add({at(i), at(j)}, {at(i), at(j + 1)}, {at(i + 1), at(j + 1)});
    }
  }
  return mesh;
}

Eigen::AlignedBox3d box_around(const Eigen::Vector3d& middle, double side) {
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * side);
  return {middle - half, middle + half};
}

/// Whether the shadow grown from the triangle towards the middle of the box hides it from a point.
bool hides(const TriangleMesh& mesh, const Eigen::Vector3d& point_m,
           const Eigen::AlignedBox3d& box) {
  const TriangleNeighbours neighbours(mesh);
  SurfaceShadow shadow(neighbours);
  for (std::uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
    if (shadow.hides(triangle, point_m, box.center(), box)) return true;
  }
  return false;
}

// From the origin the square's shadow at z = 3 is 6 m wide; nothing lies exactly behind an edge.
const Eigen::AlignedBox3d kBehind = box_around({0.11, 0.23, 3.0}, 2.0);

TEST(SurfaceShadow, IsThatOfAllTrianglesTogether) {
  EXPECT_TRUE(hides(square(1, [](int, int) { return true; }), {0, 0, 0}, kBehind));
  EXPECT_TRUE(hides(square(8, [](int, int) { return true; }), {0, 0, 0}, kBehind));
}

TEST(SurfaceShadow, HasAHoleWhereATriangleIsMissing) {
  // The box is seen through x, y within +-0.56 or so of the square: squares 1 to 6 of 8.
  EXPECT_FALSE(hides(square(8, [](int i, int j) { return i != 3 || j != 5; }), {0, 0, 0}, kBehind));
  EXPECT_TRUE(hides(square(8, [](int i, int j) { return i != 0 || j != 7; }), {0, 0, 0}, kBehind));
}

TEST(SurfaceShadow, BeginsBehindTheSurface) {
  const TriangleMesh mesh = square(8, [](int, int) { return true; });
  EXPECT_FALSE(hides(mesh, {0, 0, 0}, box_around({0.11, 0.23, 0.5}, 0.2)));
  EXPECT_FALSE(hides(mesh, {0, 0, 0}, box_around({0.11, 0.23, 1.0}, 0.2)));
  EXPECT_TRUE(hides(mesh, {0, 0, 0}, box_around({0.11, 0.23, 1.2}, 0.2)));
}

TEST(SurfaceShadow, IsNotOfTheSurfaceThePointLiesOn) {
  const TriangleMesh mesh = square(8, [](int, int) { return true; });
  EXPECT_FALSE(hides(mesh, {0.1, 0.2, 0.9995}, kBehind));
  EXPECT_TRUE(hides(mesh, {0.1, 0.2, 0.9985}, kBehind));
}

TEST(SurfaceShadow, GoesRoundTheEdgesOfABoxFromInside) {
  TriangleMesh mesh;
  add_box(mesh, {0, 0, 0}, {0.1, 0.1, 0.1});
  EXPECT_TRUE(hides(mesh, {0.05, 0.05, 0.05}, box_around({2.0, 2.1, 1.9}, 1.0)));
}

TEST(SurfaceShadow, EndsAtASilhouette) {
  // From outside the far faces of the box join the near ones behind its silhouette.
  TriangleMesh mesh;
  add_box(mesh, {-0.5, -0.5, 1.0}, {0.5, 0.5, 1.5});
  EXPECT_TRUE(hides(mesh, {0, 0, 0}, box_around({0.11, 0.23, 4.0}, 1.0)));
  EXPECT_FALSE(hides(mesh, {0, 0, 0}, box_around({0.11, 0.23, 4.0}, 5.0)));
}

TEST(SurfaceShadow, HidesOnlyWhatEveryRaySaysIsHidden) {
  int hidden = 0;
  int larger_than_a_triangle = 0;
  for (int world = 0; world < 200; ++world) {
    RandomStream random(world, 0, 0, RandomPurpose::InitialSimplex);
    const Eigen::Vector3d size(2.0, 2.0, 2.0);
    // A crumpled, holed sheet whose triangles share edges, and loose ones that cut through it.
    const std::uint64_t holes = random.below(3);
    TriangleMesh mesh = square(6, [&](int, int) { return random.below(36) >= holes; });
    const double crumple = world % 2 == 0 ? 2.0 : 0.3;
    for (Eigen::Vector3f& vertex : mesh.vertices_m) {
      // The same for the same corner, so that neighbours stay neighbours.
      const auto x = static_cast<double>(vertex.x());
      const auto y = static_cast<double>(vertex.y());
      vertex += (0.1 * crumple *
                 Eigen::Vector3d(std::sin(37.0 * x + 11.0 * y + world),
                                 std::sin(23.0 * y - 5.0 * x + world),
                                 std::sin(13.0 * x + 29.0 * y + world)))
                    .cast<float>();
    }
    for (int i = 0; i < 3; ++i) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
      for (int corner = 0; corner < 3; ++corner) {
        mesh.vertices_m.push_back(random_point(random, -size, size).cast<float>());
      }
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
    const Scene scene(mesh);
    const TriangleNeighbours neighbours(scene.mesh());
    SurfaceShadow shadow(neighbours);
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3d point = random_point(random, {-1, -1, -1}, {1, 1, 0.9});
      const Eigen::AlignedBox3d box =
          box_around(random_point(random, {-1, -1, 1}, {1, 1, 3}), 0.02 + random.uniform());
      const auto triangle = hidden_by(scene, point, box.center());
      if (!triangle || !shadow.hides(*triangle, point, box.center(), box)) continue;
      ++hidden;
      bool one = true;
      for (int ray = 0; ray < 60; ++ray) {
        Eigen::Vector3d target = random_point(random, box.min(), box.max());
        if (ray < 8) target = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(ray));
        ASSERT_NE(hidden_by(scene, point, target), std::nullopt)
            << "world " << world << ", " << point.transpose() << " to " << target.transpose();
        one = one && shadow.covers(*triangle, point, target);
      }
      larger_than_a_triangle += one ? 0 : 1;
    }
  }
  RecordProperty("hidden", hidden);
  EXPECT_GT(hidden, 2000);
  EXPECT_GT(larger_than_a_triangle, 1000);
}

}  // namespace
}  // namespace nextview
