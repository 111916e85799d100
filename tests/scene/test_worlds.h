#pragma once

#include <Eigen/Core>
#include <filesystem>

#include "scene/triangle_mesh.h"
#include "sensor/random_stream.h"

namespace nextview {

inline const std::filesystem::path kSourceFolder = NEXTVIEW_SOURCE_DIR;
inline const std::filesystem::path kDataFolder = kSourceFolder / "tests/scene/data";
inline const std::filesystem::path kScenesFolder = kSourceFolder / "scenes";
inline const std::filesystem::path kSharedScenesFolder = kSourceFolder / "../shared/scenes";

inline RandomStream random_stream(int seed) {
  return RandomStream(seed, 0, 0, RandomPurpose::RangeNoise);
}

/// Uniform in a cube about the origin.
inline Eigen::Vector3d random_point(RandomStream& random, double half_side) {
  const double x = random.uniform();
  const double y = random.uniform();
  const double z = random.uniform();
  return (2.0 * Eigen::Vector3d(x, y, z) - Eigen::Vector3d::Ones()) * half_side;
}

inline Eigen::Vector3d random_direction(RandomStream& random) {
  Eigen::Vector3d direction;
  do {
    direction = random_point(random, 1.0);
  } while (direction.norm() < 0.1 || direction.norm() > 1.0);
  return direction.normalized();
}

/// Triangles of about half a metre here and there in a cube of 4 m.
inline TriangleMesh triangle_soup(RandomStream& random, int triangles) {
  TriangleMesh mesh;
  for (int i = 0; i < triangles; ++i) {
    const Eigen::Vector3d middle = random_point(random, 2.0);
    const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
    for (int corner = 0; corner < 3; ++corner) {
      mesh.vertices_m.push_back((middle + random_point(random, 0.5)).cast<float>());
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

}  // namespace nextview
