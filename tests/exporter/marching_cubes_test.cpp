#include "exporter/marching_cubes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>
#include <set>

namespace nextview {
namespace {

Eigen::Vector3d midpoint(int edge) {
  const CubeEdge at = cube_edge(edge);
  return Eigen::Vector3d(at.corner & 1, at.corner >> 1 & 1, at.corner >> 2 & 1) +
         0.5 * Eigen::Vector3d::Unit(at.axis);
}

Eigen::Vector3d normal_of(const std::array<int, 3>& triangle) {
  const Eigen::Vector3d a = midpoint(triangle[0]);
  return (midpoint(triangle[1]) - a).cross(midpoint(triangle[2]) - a);
}

TEST(MarchingCubes, HasTwelveDistinctEdges) {
  std::set<std::pair<int, int>> edges;
  for (int edge = 0; edge < kCubeEdges; ++edge) {
    const CubeEdge at = cube_edge(edge);
    EXPECT_EQ(at.corner >> at.axis & 1, 0);
    edges.insert({at.axis, at.corner});
  }
  EXPECT_EQ(edges.size(), 12U);
}

TEST(MarchingCubes, CutsOffOneCornerAndLooksAway) {
  ASSERT_EQ(cube_triangles(1).size(), 1U);
  EXPECT_GT(normal_of(cube_triangles(1)[0]).dot(Eigen::Vector3d::Ones()), 0.0);
  ASSERT_EQ(cube_triangles(254).size(), 1U);
  EXPECT_LT(normal_of(cube_triangles(254)[0]).dot(Eigen::Vector3d::Ones()), 0.0);
}

TEST(MarchingCubes, CutsAHalfCubeFlat) {
  // The four lower corners are solid.
  const auto triangles = cube_triangles(0b00001111);
  ASSERT_EQ(triangles.size(), 2U);
  for (const auto& triangle : triangles) {
    EXPECT_TRUE(normal_of(triangle).normalized().isApprox(Eigen::Vector3d::UnitZ()));
  }
}

TEST(MarchingCubes, HasNoSurfaceInAWholeCube) {
  EXPECT_TRUE(cube_triangles(0).empty());
  EXPECT_TRUE(cube_triangles(255).empty());
}

TEST(MarchingCubes, JoinsSolidCornersAcrossAFace) {
  // Corners 0 and 3 lie across the face z = 0: one piece, and not two triangles apart.
  EXPECT_GT(cube_triangles(0b00001001).size(), 2U);
  // Their complement leaves two free corners apart.
  EXPECT_EQ(cube_triangles(0b11110110).size(), 2U);
}

/// In every case the surface crosses each crossed edge and no other, and ends on the cube's faces
/// only; no cut lies in a face, where the neighbour might make the same one.
TEST(MarchingCubes, EndsOnTheFacesOnly) {
  for (unsigned solid = 0; solid < 256; ++solid) {
    std::set<int> used;
    std::map<std::pair<int, int>, int> directed;
    for (const auto& triangle : cube_triangles(solid)) {
      for (std::size_t k = 0; k < 3; ++k) {
        used.insert(triangle[k]);
        ++directed[{triangle[k], triangle[(k + 1) % 3]}];
      }
    }
    for (int edge = 0; edge < kCubeEdges; ++edge) {
      const CubeEdge at = cube_edge(edge);
      const bool crossed = (solid >> at.corner & 1U) != (solid >> (at.corner | 1 << at.axis) & 1U);
      EXPECT_EQ(used.contains(edge), crossed) << "case " << solid << ", edge " << edge;
    }
    for (const auto& [edges, count] : directed) {
      EXPECT_EQ(count, 1) << "case " << solid;
      const Eigen::Vector3d middle = 0.5 * (midpoint(edges.first) + midpoint(edges.second));
      const bool on_face = (middle.array() == 0.0).any() || (middle.array() == 1.0).any();
      const bool inner = directed.contains({edges.second, edges.first});
      EXPECT_NE(on_face, inner) << "case " << solid;
    }
  }
}

}  // namespace
}  // namespace nextview
