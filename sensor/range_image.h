#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sensor/sensor_geometry.h"
#include "sensor/sensor_pose.h"

namespace nextview {

/// One 2.5-D range image with everything needed to place its points in the world (P2, P6).
struct RangeImage {
  SensorPose pose;  ///< the pose it was taken from; for people, the two members below are exact
  Eigen::Matrix3d world_from_sensor = Eigen::Matrix3d::Identity();  ///< rotation only
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();             ///< optical centre, world frame
  RayTable rays;
  RangeLimits limits;
  /// Distance along each ray in metres, index v * columns + u, a multiple of 0.1 mm.
  /// +inf: no surface within limits.max_m (so the ray is known free up to there);
  /// NaN: no valid measurement (so nothing is known).
  std::vector<float> range_m;
};

/// Rounds a distance of 0 or more to the nearest 0.1 mm, as a real scanner's are; keeps +inf and
/// NaN. Through an integer and not std::round, which is a call for every pixel.
inline float quantise_range(double range_m) {
  constexpr double kLongest = 1e12;
  if (!(range_m < kLongest)) return static_cast<float>(range_m);
  return static_cast<float>(static_cast<double>(static_cast<std::int64_t>(range_m * 1e4 + 0.5)) /
                            1e4);
}

}  // namespace nextview
