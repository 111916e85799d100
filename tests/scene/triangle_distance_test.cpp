#include "scene/triangle_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/scene/test_worlds.h"

namespace nextview {
namespace {

const Triangle kTriangle = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(4, 0, 0),
                            Eigen::Vector3d(0, 3, 0)};

TEST(NearestPoint, InEveryRegionOfTheTriangle) {
  const auto expect = [](const Eigen::Vector3d& p, const Eigen::Vector3d& nearest) {
    EXPECT_LT((nearest_point(kTriangle, p) - nearest).norm(), 1e-12) << p.transpose();
  };
  expect({1, 1, 5}, {1, 1, 0});    // over the inside
  expect({-1, -2, 1}, {0, 0, 0});  // beyond each corner
  expect({7, -1, 0}, {4, 0, 0});
  expect({-1, 8, -3}, {0, 3, 0});
  expect({2, -1, 1}, {2, 0, 0});  // beyond each edge
  expect({-2, 1, 0}, {0, 1, 0});
  expect({2 + 0.6, 1.5 + 0.8, 0}, {2, 1.5, 0});
}

TEST(SegmentTriangleDistance, WorkedByHand) {
  EXPECT_EQ(segment_triangle_distance({1, 1, -1}, {1, 1, 1}, kTriangle), 0.0);  // through
  EXPECT_DOUBLE_EQ(segment_triangle_distance({1, 1, 2}, {1, 1, 5}, kTriangle), 2.0);
  EXPECT_DOUBLE_EQ(segment_triangle_distance({-5, 1, 2}, {5, 1, 2}, kTriangle), 2.0);  // parallel
  EXPECT_DOUBLE_EQ(segment_triangle_distance({-1, -1, 0}, {5, -1, 0}, kTriangle), 1.0);
  EXPECT_DOUBLE_EQ(segment_triangle_distance({2, -2, -3}, {2, -2, 3}, kTriangle), 2.0);
  EXPECT_DOUBLE_EQ(segment_triangle_distance({1, 1, 7}, {1, 1, 7}, kTriangle), 7.0);  // a point
  EXPECT_EQ(segment_triangle_distance({-1, 1, 0}, {5, 1, 0}, kTriangle), 0.0);  // in its plane
}

// The distance of a point to a triangle by looking at a fine grid of its points.
double sampled_distance(const Triangle& triangle, const Eigen::Vector3d& p) {
  constexpr int kSteps = 60;
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; i + j <= kSteps; ++j) {
      const double s = static_cast<double>(i) / kSteps;
      const double t = static_cast<double>(j) / kSteps;
      const Eigen::Vector3d q =
          triangle[0] + s * (triangle[1] - triangle[0]) + t * (triangle[2] - triangle[0]);
      nearest = std::min(nearest, (p - q).norm());
    }
  }
  return nearest;
}

TEST(NearestPoint, NoPointOfTheTriangleIsNearer) {
  RandomStream random = random_stream(1);
  int cases = 0;
  for (int i = 0; i < 2000; ++i) {
    const Triangle triangle = {random_point(random, 1.0), random_point(random, 1.0),
                               random_point(random, 1.0)};
    const Eigen::Vector3d p = random_point(random, 2.0);
    const double distance = (nearest_point(triangle, p) - p).norm();
    const double sampled = sampled_distance(triangle, p);
    EXPECT_LE(distance, sampled + 1e-9);
    EXPECT_GE(distance, sampled - 0.08);  // the grid's points are at most this far apart
    ++cases;
  }
  EXPECT_EQ(cases, 2000);
}

// The distance to a convex shape is a convex function along a line: halve in on its minimum.
double searched_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                         const Triangle& triangle) {
  const auto distance_at = [&](double t) {
    const Eigen::Vector3d p = a + t * (b - a);
    return (nearest_point(triangle, p) - p).norm();
  };
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 120; ++i) {
    const double third = (high - low) / 3.0;
    (distance_at(low + third) < distance_at(high - third) ? high : low) =
        distance_at(low + third) < distance_at(high - third) ? high - third : low + third;
  }
  return distance_at(0.5 * (low + high));
}

TEST(SegmentTriangleDistance, AgreesWithASearchAlongTheSegment) {
  RandomStream random = random_stream(2);
  int apart = 0;
  int crossing = 0;
  for (int i = 0; i < 5000; ++i) {
    const Triangle triangle = {random_point(random, 1.0), random_point(random, 1.0),
                               random_point(random, 1.0)};
    const Eigen::Vector3d a = random_point(random, 1.5);
    const Eigen::Vector3d b = random_point(random, 1.5);
    const double distance = segment_triangle_distance(a, b, triangle);
    EXPECT_NEAR(distance, searched_distance(a, b, triangle), 1e-6);
    ++(distance > 0.0 ? apart : crossing);
  }
  EXPECT_GT(apart, 3000);
  EXPECT_GT(crossing, 200);
}

}  // namespace
}  // namespace nextview
