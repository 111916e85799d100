#include "planner/field_of_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nextview {

namespace {

// So that the outermost rays themselves are inside.
constexpr double kTolerance_rad = 1e-9;

double azimuth_rad(const Eigen::Vector3d& direction) {
  return std::atan2(direction.x(), direction.y());
}
double elevation_rad(const Eigen::Vector3d& direction) {
  return std::asin(std::clamp(direction.z(), -1.0, 1.0));
}
double angle_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0));
}

}  // namespace

bool FieldOfView::contains(const Eigen::Vector3d& direction) const {
  if (direction.y() < least_ahead) return false;  // most are, and need no angles
  const double azimuth = azimuth_rad(direction);
  const double elevation = elevation_rad(direction);
  return azimuth >= azimuth_min_rad && azimuth <= azimuth_max_rad &&
         elevation >= elevation_min_rad && elevation <= elevation_max_rad;
}

FieldOfView field_of_view(const RayTable& rays) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  FieldOfView field{kInfinity, -kInfinity, kInfinity, -kInfinity, kInfinity, 0.0};
  for (int v = 0; v < rays.rows(); ++v) {
    for (int u = 0; u < rays.columns(); ++u) {
      const Eigen::Vector3d ray = rays.ray(u, v);
      field.least_ahead = std::min(field.least_ahead, ray.y() - kTolerance_rad);
      field.azimuth_min_rad = std::min(field.azimuth_min_rad, azimuth_rad(ray) - kTolerance_rad);
      field.azimuth_max_rad = std::max(field.azimuth_max_rad, azimuth_rad(ray) + kTolerance_rad);
      field.elevation_min_rad =
          std::min(field.elevation_min_rad, elevation_rad(ray) - kTolerance_rad);
      field.elevation_max_rad =
          std::max(field.elevation_max_rad, elevation_rad(ray) + kTolerance_rad);
      if (u > 0)
        field.spacing_rad = std::max(field.spacing_rad, angle_rad(ray, rays.ray(u - 1, v)));
      if (v > 0)
        field.spacing_rad = std::max(field.spacing_rad, angle_rad(ray, rays.ray(u, v - 1)));
    }
  }
  return field;
}

}  // namespace nextview
