#pragma once

#include <Eigen/Core>
#include <numbers>

#include "sensor/ray_table.h"

namespace nextview {

constexpr double kDegree = std::numbers::pi / 180.0;

/// The ray of a pixel of the picture whose columns, stripes or meridians, are the table's rows.
inline Eigen::Vector3d ray_at(const RayTable& rays, int u, int v) { return rays.ray(v, u); }

}  // namespace nextview
