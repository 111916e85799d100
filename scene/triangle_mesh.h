#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace nextview {

/// The surfaces of a scene: world frame, z up, metres. Which way a triangle is wound means nothing;
/// every surface is seen from both sides.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices_m;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into vertices_m
  /// Where the world's origin lies in the CAD file's frame, after unit and axis: whole kilometres,
  /// and zero unless the file's coordinates are too large for floats.
  Eigen::Vector3d origin_in_file_m = Eigen::Vector3d::Zero();

  /// Sum of the areas of all triangles, one side each.
  double area_m2() const;
  /// Smallest box around all triangles; empty when there are none.
  Eigen::AlignedBox3d bounds_m() const;
  /// Corner 0, 1 or 2 of a triangle.
  Eigen::Vector3d corner_m(std::size_t triangle, int corner) const {
    return vertices_m[triangles[triangle][static_cast<std::size_t>(corner)]].cast<double>();
  }
};

/// XXH3-128 over vertices and triangles in little-endian order, as 32 hexadecimal digits. The same
/// for the same file read with the same options.
std::string mesh_digest(const TriangleMesh& mesh);

}  // namespace nextview
