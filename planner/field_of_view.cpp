#include "planner/field_of_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sensor/elementary_functions.h"

namespace nextview {

namespace {

// So that the outermost rays themselves are inside.
constexpr double kTolerance_rad = 1e-9;

double azimuth_rad(const Eigen::Vector3d& direction) {
  return elementary::atan2(direction.x(), direction.y());
}
double sine_of_elevation(const Eigen::Vector3d& direction) {
  return std::clamp(direction.z(), -1.0, 1.0);
}

// Whether an angle is in [min, max]. About what it is tells, unless that is near an end.
template <class Angle>
bool is_between(double about_rad, double min_rad, double max_rad, const Angle& angle_rad) {
  constexpr double kAbout_rad = 1e-12;
  if (about_rad < min_rad - kAbout_rad || about_rad > max_rad + kAbout_rad) return false;
  if (about_rad > min_rad + kAbout_rad && about_rad < max_rad - kAbout_rad) return true;
  const double angle = angle_rad();
  return angle >= min_rad && angle <= max_rad;
}

}  // namespace

bool FieldOfView::contains(const Eigen::Vector3d& direction) const {
  if (direction.y() < least_ahead) return false;  // most are, and need no angles
  const double sine = sine_of_elevation(direction);
  return is_between(std::atan2(direction.x(), direction.y()), azimuth_min_rad, azimuth_max_rad,
                    [&] { return azimuth_rad(direction); }) &&
         is_between(std::asin(sine), elevation_min_rad, elevation_max_rad,
                    [&] { return elementary::asin(sine); });
}

FieldOfView field_of_view(const RayTable& rays) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  FieldOfView field;
  field.least_ahead = kInfinity;
  field.azimuth_min_rad = kInfinity;
  field.azimuth_max_rad = -kInfinity;
  double least_sine = 1.0;  // of an elevation
  double most_sine = -1.0;
  double least_cosine = 1.0;  // between neighbours
  const auto see_neighbour = [&](const Eigen::Vector3d& ray, const Eigen::Vector3d& neighbour) {
    least_cosine = std::min(least_cosine, std::clamp(ray.dot(neighbour), -1.0, 1.0));
  };
  for (int v = 0; v < rays.rows(); ++v) {
    for (int u = 0; u < rays.columns(); ++u) {
      const Eigen::Vector3d ray = rays.ray(u, v);
      field.least_ahead = std::min(field.least_ahead, ray.y() - kTolerance_rad);
      const double azimuth = azimuth_rad(ray);
      field.azimuth_min_rad = std::min(field.azimuth_min_rad, azimuth - kTolerance_rad);
      field.azimuth_max_rad = std::max(field.azimuth_max_rad, azimuth + kTolerance_rad);
      least_sine = std::min(least_sine, sine_of_elevation(ray));
      most_sine = std::max(most_sine, sine_of_elevation(ray));
      if (u > 0) see_neighbour(ray, rays.ray(u - 1, v));
      if (v > 0) see_neighbour(ray, rays.ray(u, v - 1));
    }
  }
  field.elevation_min_rad = elementary::asin(least_sine) - kTolerance_rad;
  field.elevation_max_rad = elementary::asin(most_sine) + kTolerance_rad;
  field.spacing_rad = elementary::acos(least_cosine);
  return field;
}

}  // namespace nextview
