#include "scoring/shadow_union.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/scoring/room_mesh.h"

namespace nextview {
namespace {

/// A rectangle across the z axis, of two triangles with vertices of their own.
void add_pane(TriangleMesh& mesh, const Eigen::Vector2d& min, const Eigen::Vector2d& max,
              double z) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
  for (const Eigen::Vector2d& at :
       {min, Eigen::Vector2d(max.x(), min.y()), max, Eigen::Vector2d(min.x(), max.y())}) {
    mesh.vertices_m.push_back(Eigen::Vector3d(at.x(), at.y(), z).cast<float>());
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

struct Answer {
  bool hides;
  std::vector<std::uint32_t> triangles;
  std::vector<SpacePiece> open;
};
Answer answer(const TriangleMesh& mesh, const Eigen::AlignedBox3d& box) {
  const Scene scene(mesh);
  const TriangleNeighbours neighbours(scene.mesh());
  ShadowUnion shadows(scene, neighbours);
  Answer result;
  result.hides = shadows.hides(Eigen::Vector3d::Zero(), box, result.triangles, result.open);
  return result;
}

// From the origin it is seen within x, y of +-0.4 at z = 1.
const Eigen::AlignedBox3d kBox(Eigen::Vector3d(-1.0, -1.0, 2.5), Eigen::Vector3d(1.0, 1.0, 4.0));

TEST(ShadowUnion, IsOfTwoPanesOneBehindTheOtherThatOverlap) {
  TriangleMesh mesh;
  add_pane(mesh, {-1.0, -1.0}, {0.1, 1.0}, 1.0);
  add_pane(mesh, {0.0, -2.0}, {2.0, 2.0}, 1.5);
  const Answer both = answer(mesh, kBox);
  EXPECT_TRUE(both.hides);
  EXPECT_GE(both.triangles.size(), 3u);
  EXPECT_TRUE(both.open.empty());
  mesh.triangles.resize(2);
  EXPECT_FALSE(answer(mesh, kBox).hides);
}

TEST(ShadowUnion, HasNoGapAlongSharedEdges) {
  TriangleMesh mesh;
  add_box(mesh, {-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0});
  const Answer inside = answer(mesh, kBox);
  EXPECT_TRUE(inside.hides);
  EXPECT_TRUE(inside.open.empty());
}

TEST(ShadowUnion, HasAHoleWhereThePanesLeaveOne) {
  TriangleMesh mesh;
  add_pane(mesh, {-1.0, -1.0}, {0.1, 1.0}, 1.0);
  add_pane(mesh, {0.16, -2.0}, {2.0, 2.0}, 1.5);  // begins at 0.107 of z = 1
  EXPECT_FALSE(answer(mesh, kBox).hides);
}

TEST(ShadowUnion, LeavesAStripOpenWherePanesOnlyTouch) {
  TriangleMesh mesh;
  add_pane(mesh, {-1.0, -1.0}, {0.1, 1.0}, 1.0);
  add_pane(mesh, {0.1, -1.5}, {1.0, 1.5}, 1.0);  // an edge that is not the same
  const Answer touching = answer(mesh, kBox);
  ASSERT_TRUE(touching.hides);
  ASSERT_FALSE(touching.open.empty());
  const auto is_open = [&](const Eigen::Vector3d& at) {
    return std::any_of(touching.open.begin(), touching.open.end(), [&](const SpacePiece& piece) {
      return std::all_of(
          piece.half_spaces.begin(), piece.half_spaces.begin() + static_cast<int>(piece.size),
          [&](const HalfSpace& space) { return space.normal.dot(at) >= space.offset_m; });
    });
  };
  EXPECT_TRUE(is_open({0.3, 0.2, 3.0}));  // behind where they touch
  EXPECT_FALSE(is_open({0.31, 0.2, 3.0}));
  EXPECT_FALSE(is_open({0.29, 0.2, 3.0}));
}

TEST(ShadowUnion, LeavesOpenWhatLiesBeforeATriangle) {
  TriangleMesh mesh;
  add_pane(mesh, {-3.0, -3.0}, {3.0, 3.0}, 3.0);  // through the box
  const Answer through = answer(mesh, kBox);
  ASSERT_TRUE(through.hides);
  ASSERT_EQ(through.open.size(), 2u);  // of each triangle
  for (const SpacePiece& piece : through.open) {
    EXPECT_TRUE(piece.box.contains(Eigen::Vector3d::Zero().eval()));
    EXPECT_LT(piece.box.max().z(), 3.01);
  }
}

}  // namespace
}  // namespace nextview
