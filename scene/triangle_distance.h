#pragma once

#include <Eigen/Core>
#include <array>

namespace nextview {

/// The corners of a triangle.
using Triangle = std::array<Eigen::Vector3d, 3>;

/// Point of a triangle that is nearest to p.
Eigen::Vector3d nearest_point(const Triangle& triangle, const Eigen::Vector3d& p);

/// Distance between the segment ab (which may be a point) and a triangle; 0 where they meet.
double segment_triangle_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                 const Triangle& triangle);

}  // namespace nextview
