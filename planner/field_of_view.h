#pragma once

#include <Eigen/Core>

#include "sensor/ray_table.h"

namespace nextview {

/// Where a sensor's rays go, as a box of angles in its frame: azimuth atan2(x, y), positive to the
/// right of the optical axis, and elevation asin(z); and no farther from the axis than any ray.
/// Near its corners the box may hold a little more than the rays of a tilted line scan, whose outer
/// columns are bent.
struct FieldOfView {
  double azimuth_min_rad = 0.0;
  double azimuth_max_rad = 0.0;
  double elevation_min_rad = 0.0;
  double elevation_max_rad = 0.0;
  double least_ahead = 1.0;  ///< the least component of a ray along the optical axis
  double spacing_rad = 0.0;  ///< the largest angle between neighbours of a row or a column

  /// Of a unit vector in the sensor's frame.
  bool contains(const Eigen::Vector3d& direction) const;
};

FieldOfView field_of_view(const RayTable& rays);

}  // namespace nextview
