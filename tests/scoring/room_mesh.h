#pragma once

#include <Eigen/Core>

#include "scene/triangle_mesh.h"
#include "sensor/random_stream.h"

namespace nextview {

/// Adds the twelve triangles of an axis-aligned box's surface.
inline void add_box(TriangleMesh& mesh, const Eigen::Vector3d& min, const Eigen::Vector3d& max) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d vertex((corner & 1) != 0 ? max.x() : min.x(),
                                 (corner & 2) != 0 ? max.y() : min.y(),
                                 (corner & 4) != 0 ? max.z() : min.z());
    mesh.vertices_m.push_back(vertex.cast<float>());
  }
  constexpr std::uint32_t kFaces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                          {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
  for (const auto& face : kFaces) {
    mesh.triangles.push_back({first + face[0], first + face[1], first + face[2]});
    mesh.triangles.push_back({first + face[0], first + face[2], first + face[3]});
  }
}

/// A closed room with a corner at the origin.
inline TriangleMesh room(const Eigen::Vector3d& size) {
  TriangleMesh mesh;
  add_box(mesh, Eigen::Vector3d::Zero(), size);
  return mesh;
}

/// A point in a box, uniformly.
inline Eigen::Vector3d random_point(RandomStream& random, const Eigen::Vector3d& min,
                                    const Eigen::Vector3d& max) {
  const double x = random.uniform();
  const double y = random.uniform();
  const double z = random.uniform();
  return min + Eigen::Vector3d(x, y, z).cwiseProduct(max - min);
}

}  // namespace nextview
