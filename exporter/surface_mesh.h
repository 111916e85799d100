#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace nextview {

/// A surface in triangles: metres, world frame, wound counter-clockwise seen from free space.
struct SurfaceMesh {
  std::vector<Eigen::Vector3f> vertices_m;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into vertices_m
};

/// Twice a triangle's area times its normal.
Eigen::Vector3d area_vector_m2(const SurfaceMesh& mesh,
                               const std::array<std::uint32_t, 3>& triangle);

/// The shortest height of a triangle: how far it is from having no area.
double least_height_m(const SurfaceMesh& mesh, const std::array<std::uint32_t, 3>& triangle);

}  // namespace nextview
