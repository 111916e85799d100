#include "scene/brute_force_scene.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "scene/triangle_distance.h"

namespace nextview {
namespace {

// Where along the ray the triangle is met, at 0 or beyond (Moller and Trumbore), in double.
std::optional<double> meet(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                           const Triangle& triangle) {
  const Eigen::Vector3d edge1 = triangle[1] - triangle[0];
  const Eigen::Vector3d edge2 = triangle[2] - triangle[0];
  const Eigen::Vector3d p = direction.cross(edge2);
  const double determinant = edge1.dot(p);
  if (determinant == 0.0) return std::nullopt;
  const Eigen::Vector3d s = origin - triangle[0];
  const double u = s.dot(p) / determinant;
  const Eigen::Vector3d q = s.cross(edge1);
  const double v = direction.dot(q) / determinant;
  const double t = edge2.dot(q) / determinant;
  if (u < 0.0 || v < 0.0 || u + v > 1.0 || t < 0.0) return std::nullopt;
  return t;
}

Triangle triangle_of(const TriangleMesh& mesh, std::size_t i) {
  return {mesh.corner_m(i, 0), mesh.corner_m(i, 1), mesh.corner_m(i, 2)};
}

}  // namespace

std::optional<BruteForceScene::Hit> BruteForceScene::first_hit(
    const Eigen::Vector3d& origin_m, const Eigen::Vector3d& direction) const {
  std::optional<Hit> first;
  for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
    const std::optional<double> distance = meet(origin_m, direction, triangle_of(mesh_, i));
    if (distance && (!first || *distance < first->distance_m)) {
      first = Hit{*distance, static_cast<std::uint32_t>(i)};
    }
  }
  return first;
}

double BruteForceScene::clearance_m(const Eigen::Vector3d& a_m, const Eigen::Vector3d& b_m,
                                    double at_most_m) const {
  double nearest = at_most_m;
  for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
    nearest = std::min(nearest, segment_triangle_distance(a_m, b_m, triangle_of(mesh_, i)));
  }
  return nearest;
}

}  // namespace nextview
