#include "exporter/surface_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace nextview {

namespace {

std::array<Eigen::Vector3d, 3> sides_of(const SurfaceMesh& mesh,
                                        const std::array<std::uint32_t, 3>& triangle) {
  const Eigen::Vector3d a = mesh.vertices_m[triangle[0]].cast<double>();
  const Eigen::Vector3d b = mesh.vertices_m[triangle[1]].cast<double>();
  const Eigen::Vector3d c = mesh.vertices_m[triangle[2]].cast<double>();
  return {b - a, c - a, c - b};
}

}  // namespace

Eigen::Vector3d area_vector_m2(const SurfaceMesh& mesh,
                               const std::array<std::uint32_t, 3>& triangle) {
  const auto sides = sides_of(mesh, triangle);
  return sides[0].cross(sides[1]);
}

double least_height_m(const SurfaceMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const auto sides = sides_of(mesh, triangle);
  const double longest_m = std::max({sides[0].norm(), sides[1].norm(), sides[2].norm()});
  return longest_m > 0.0 ? sides[0].cross(sides[1]).norm() / longest_m : 0.0;
}

}  // namespace nextview
