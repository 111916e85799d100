#include "scene/triangle_mesh.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <bit>

namespace nextview {

static_assert(std::endian::native == std::endian::little, "the digest hashes memory as it lies");
static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));

double TriangleMesh::area_m2() const {
  double area = 0.0;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Eigen::Vector3d a = corner_m(i, 0);
    area += 0.5 * (corner_m(i, 1) - a).cross(corner_m(i, 2) - a).norm();
  }
  return area;
}

Eigen::AlignedBox3d TriangleMesh::bounds_m() const {
  Eigen::AlignedBox3d bounds;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (int corner = 0; corner < 3; ++corner) {
      bounds.extend(corner_m(i, corner));
    }
  }
  return bounds;
}

std::string mesh_digest(const TriangleMesh& mesh) {
  // The vertices' hash seeds that of the triangles, so that no bytes can move from one to the
  // other.
  const XXH128_hash_t vertices =
      XXH3_128bits(mesh.vertices_m.data(), mesh.vertices_m.size() * sizeof(Eigen::Vector3f));
  const XXH128_hash_t all = XXH3_128bits_withSeed(mesh.triangles.data(),
                                                  mesh.triangles.size() * sizeof(mesh.triangles[0]),
                                                  vertices.low64 ^ vertices.high64);
  return fmt::format("{:016x}{:016x}", all.high64, all.low64);
}

}  // namespace nextview
