#pragma once

#include <optional>

#include "scene/triangle_mesh.h"

namespace nextview {

/// The plain twin of Scene: the same questions answered by going through all triangles in double.
class BruteForceScene {
 public:
  struct Hit {
    double distance_m;  ///< in lengths of the direction given
    std::uint32_t triangle;
  };

  explicit BruteForceScene(TriangleMesh mesh) : mesh_(std::move(mesh)) {}

  std::optional<Hit> first_hit(const Eigen::Vector3d& origin_m,
                               const Eigen::Vector3d& direction) const;
  double clearance_m(const Eigen::Vector3d& a_m, const Eigen::Vector3d& b_m,
                     double at_most_m) const;

 private:
  TriangleMesh mesh_;
};

}  // namespace nextview
