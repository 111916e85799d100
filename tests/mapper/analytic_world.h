#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "sensor/random_stream.h"
#include "sensor/range_image.h"

namespace nextview {

/// A world of planes, boxes and spheres whose distances along a ray are known in closed form.
struct AnalyticWorld {
  struct Plane {
    Eigen::Vector3d normal;
    double offset_m;  ///< normal . p = offset
  };
  struct Box {
    Eigen::Vector3d min_m, max_m;  ///< seen from inside as well as from outside
  };
  struct Sphere {
    Eigen::Vector3d center_m;
    double radius_m;
  };
  std::vector<Plane> planes;
  std::vector<Box> boxes;
  std::vector<Sphere> spheres;

  /// Distance to the nearest surface along a unit direction; +inf where there is none.
  double distance_m(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
    double nearest = std::numeric_limits<double>::infinity();
    const auto meet = [&](double t) {
      if (t > 1e-9) nearest = std::min(nearest, t);
    };
    for (const Plane& plane : planes) {
      const double speed = plane.normal.dot(direction);
      if (speed != 0.0) meet((plane.offset_m - plane.normal.dot(origin)) / speed);
    }
    for (const Box& box : boxes) {
      double enter = -std::numeric_limits<double>::infinity();
      double leave = std::numeric_limits<double>::infinity();
      for (int axis = 0; axis < 3; ++axis) {
        const double a = (box.min_m[axis] - origin[axis]) / direction[axis];
        const double b = (box.max_m[axis] - origin[axis]) / direction[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
      }
      if (enter <= leave) {
        meet(enter);
        meet(leave);
      }
    }
    for (const Sphere& sphere : spheres) {
      const Eigen::Vector3d to_center = sphere.center_m - origin;
      const double along = to_center.dot(direction);
      const double square =
          along * along - to_center.squaredNorm() + sphere.radius_m * sphere.radius_m;
      if (square < 0.0) continue;
      meet(along - std::sqrt(square));
      meet(along + std::sqrt(square));
    }
    return nearest;
  }
};

/// A scan of a world, quantised, with limits and noise as the simulated sensor has them.
inline RangeImage scan_world(const AnalyticWorld& world, const RayTable& rays,
                             const RangeLimits& limits, const SensorPose& pose,
                             double range_noise_m = 0.0, RandomStream* random = nullptr) {
  RangeImage image;
  image.pose = pose;
  image.position_m = pose.position_m;
  image.world_from_sensor = world_from_sensor_rotation(pose.pan_rad, pose.tilt_rad);
  image.rays = rays;
  image.limits = limits;
  for (int v = 0; v < rays.rows(); ++v) {
    for (int u = 0; u < rays.columns(); ++u) {
      const Eigen::Vector3d direction = image.world_from_sensor * rays.ray(u, v);
      double range_m = world.distance_m(image.position_m, direction);
      if (random != nullptr) range_m += range_noise_m * random->gaussian();
      if (range_m < limits.min_m) range_m = std::numeric_limits<double>::quiet_NaN();
      if (range_m > limits.max_m) range_m = std::numeric_limits<double>::infinity();
      image.range_m.push_back(quantise_range(range_m));
    }
  }
  return image;
}

inline double uniform(RandomStream& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

inline int uniform_int(RandomStream& random, int low, int high) {
  return low + static_cast<int>(random.below(static_cast<std::uint32_t>(high - low + 1)));
}

/// A passage of 110 m along an axis with things that stand in it.
inline AnalyticWorld passage(int axis) {
  AnalyticWorld world;
  Eigen::Vector3d low = Eigen::Vector3d::Constant(-2.5);
  Eigen::Vector3d high = Eigen::Vector3d::Constant(2.5);
  low[axis] = -5.0;
  high[axis] = 105.0;
  world.boxes.push_back({low, high});
  for (int n = 0; n < 40; ++n) {
    Eigen::Vector3d place = Eigen::Vector3d::Constant(n % 2 == 0 ? 1.6 : -1.7);
    place[(axis + 1) % 3] *= n % 3 - 1;
    place[axis] = 2.6 * n + 1.0;
    world.spheres.push_back({place, 0.5});
  }
  return world;
}

}  // namespace nextview
