#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
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
  /// Distance along each ray in metres, index v * columns + u, a multiple of 0.1 mm; see RangeKind.
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

/// What a range says of its ray.
enum class RangeKind : std::int32_t {
  Point = 0,     ///< there is a surface
  NoReturn = 1,  ///< +inf, or beyond limits.max_m: free up to limits.max_m
  Invalid = 2,   ///< NaN, or nearer than limits.min_m (a driver's 0.0): nothing is known
};

/// The limits of a sensor as its ranges are held against them: rounded as ranges are, so that no
/// range leaves them by rounding.
struct RangeBounds {
  explicit RangeBounds(const RangeLimits& limits)
      : nearest_m(rounded(limits.min_m)), farthest_m(rounded(limits.max_m)) {}

  /// Without a branch, for vectors of ranges.
  RangeKind kind_of(float range_m) const {
    const auto is_invalid = static_cast<std::int32_t>(!(range_m >= nearest_m));
    const auto is_no_return = static_cast<std::int32_t>(range_m > farthest_m);
    return static_cast<RangeKind>(2 * is_invalid + is_no_return);
  }

  float nearest_m;
  float farthest_m;  ///< finite

 private:
  static float rounded(double limit_m) {
    constexpr float kLargest = std::numeric_limits<float>::max();
    return limit_m < static_cast<double>(kLargest) ? quantise_range(limit_m) : kLargest;
  }
};

}  // namespace nextview
