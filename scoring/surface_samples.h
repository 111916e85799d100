#pragma once

#include <Eigen/Core>
#include <stop_token>
#include <vector>

#include "scene/triangle_mesh.h"

namespace nextview {

/// Points spread evenly over the surfaces of a mesh: world frame, metres. Depends on the mesh
/// alone.
///
/// Every triangle gets samples_per_m2 times its area, what is left over from rounding down goes to
/// the next triangle; inside a triangle the points follow a low-discrepancy sequence. Coordinates
/// are rounded to float, the precision in which scenes are cast. The points come sorted along a
/// space-filling curve, so that consecutive ones are near each other.
/// @throws std::invalid_argument unless samples_per_m2 is positive and finite
std::vector<Eigen::Vector3f> sample_surface(const TriangleMesh& mesh, double samples_per_m2,
                                            const std::stop_token& stop = {});

}  // namespace nextview
