#include "scoring/surface_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>

#include "tests/scoring/room_mesh.h"

namespace nextview {
namespace {

TEST(SurfaceSamples, AreAsManyAsTheAreaAsksFor) {
  const TriangleMesh mesh = room({5.0, 3.0, 3.0});  // 2 (15 + 15 + 9) = 78 m2
  const auto samples = sample_surface(mesh, 400.0);
  EXPECT_NEAR(static_cast<double>(samples.size()), 78.0 * 400.0, 1.0);
}

TEST(SurfaceSamples, LieOnTheSurface) {
  const auto samples = sample_surface(room({5.0, 3.0, 2.0}), 50.0);
  ASSERT_FALSE(samples.empty());
  for (const Eigen::Vector3f& point : samples) {
    float off = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const float side = Eigen::Vector3f(5.0F, 3.0F, 2.0F)[axis];
      off = std::min({off, std::abs(point[axis]), std::abs(point[axis] - side)});
      ASSERT_GE(point[axis], -1e-5F);
      ASSERT_LE(point[axis], side + 1e-5F);
    }
    ASSERT_LE(off, 1e-5F);
  }
}

TEST(SurfaceSamples, AreSpreadEvenly) {
  TriangleMesh square;
  square.vertices_m = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  std::map<std::pair<int, int>, int> per_cell;  // of 0.5 m, so 100 samples at 400 a m2
  for (const Eigen::Vector3f& point : sample_surface(square, 400.0)) {
    ++per_cell[{static_cast<int>(point.x() / 0.5F), static_cast<int>(point.y() / 0.5F)}];
  }
  ASSERT_EQ(per_cell.size(), 64u);
  for (const auto& [cell, count] : per_cell) {
    EXPECT_NEAR(count, 100, 15) << cell.first << ", " << cell.second;
  }
}

TEST(SurfaceSamples, AreSharedFairlyByTinyTriangles) {
  // 100 x 100 squares of 1 cm: 0.02 samples a triangle, 400 on the whole square metre.
  TriangleMesh mesh;
  for (int i = 0; i < 100; ++i) {
    for (int j = 0; j < 100; ++j) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
      const float x = 0.01F * static_cast<float>(i);
      const float y = 0.01F * static_cast<float>(j);
      mesh.vertices_m.insert(
          mesh.vertices_m.end(),
          {{x, y, 0}, {x + 0.01F, y, 0}, {x + 0.01F, y + 0.01F, 0}, {x, y + 0.01F, 0}});
      mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.triangles.push_back({first, first + 2, first + 3});
    }
  }
  const auto samples = sample_surface(mesh, 400.0);
  EXPECT_NEAR(static_cast<double>(samples.size()), 400.0, 1.0);
  const auto in_left_half = std::count_if(samples.begin(), samples.end(),
                                          [](const auto& point) { return point.x() < 0.5F; });
  EXPECT_NEAR(static_cast<double>(in_left_half), 200.0, 2.0);
}

TEST(SurfaceSamples, AreTheSameEveryTime) {
  const TriangleMesh mesh = room({5.0, 3.0, 3.0});
  EXPECT_EQ(sample_surface(mesh, 400.0), sample_surface(mesh, 400.0));
}

TEST(SurfaceSamples, RefuseADensityThatCannotBe) {
  EXPECT_THROW(sample_surface(room({1, 1, 1}), 0.0), std::invalid_argument);
  EXPECT_THROW(sample_surface(room({1, 1, 1}), std::numeric_limits<double>::quiet_NaN()),
               std::invalid_argument);
}

}  // namespace
}  // namespace nextview
