#pragma once

#include <limits>
#include <numbers>

#include "mapper/voxel_grid.h"
#include "tests/mapper/analytic_world.h"

namespace nextview {

/// A room, boxes, balls and a wall, or some of them.
inline AnalyticWorld random_analytic_world(RandomStream& random, const Eigen::Vector3d& min,
                                           const Eigen::Vector3d& max) {
  const auto point = [&] {
    return Eigen::Vector3d(uniform(random, min[0], max[0]), uniform(random, min[1], max[1]),
                           uniform(random, min[2], max[2]));
  };
  AnalyticWorld world;
  const double margin = 0.1 * (max - min).norm();
  if (random.below(4) != 0) {  // a room a little smaller or larger than the window
    const auto shift = [&] { return Eigen::Vector3d::Constant(uniform(random, -margin, margin)); };
    world.boxes.push_back({min + shift(), max + shift()});
  }
  for (std::uint32_t n = random.below(3); n > 0; --n) {
    const Eigen::Vector3d corner = point();
    world.boxes.push_back({corner, corner + Eigen::Vector3d::Constant(uniform(random, 0.1, 1.0))});
  }
  for (std::uint32_t n = random.below(3); n > 0; --n) {
    world.spheres.push_back({point(), uniform(random, 0.1, 0.5) * margin});
  }
  if (random.below(2) == 0) {
    const Eigen::Vector3d normal = (point() - point()).normalized();
    world.planes.push_back({normal, normal.dot(point())});
  }
  return world;
}

/// A window with a world in it.
struct SmallWorld {
  VoxelGrid grid;
  MapWindow window;
  AnalyticWorld world;

  /// The centre of the window's first (0) or last (1) voxel.
  Eigen::Vector3d corner_m(int which) const {
    return grid.center_m(window.min + which * (window.size - VoxelIndex::Ones()));
  }
};

/// A window of any odd size and place.
inline SmallWorld random_small_world(RandomStream& random) {
  SmallWorld w;
  w.grid.voxel_size_m = random.below(2) == 0 ? 0.1 : uniform(random, 0.02, 0.3);
  for (int axis = 0; axis < 3; ++axis) {
    if (random.below(2) == 0) w.grid.origin_m[axis] = uniform(random, -5.0, 5.0);
    w.window.min[axis] = uniform_int(random, -40, 40);
    const int sizes[] = {1, 7, 8, 9, 16, 17, 20, 24};
    w.window.size[axis] = sizes[random.below(8)];
  }
  w.world = random_analytic_world(random, w.corner_m(0), w.corner_m(1));
  return w;
}

/// A sensor of any kind, of few pixels.
inline SensorGeometry random_sensor(RandomStream& random) {
  const int columns = uniform_int(random, 2, 24);
  const int rows = uniform_int(random, 2, 16);
  switch (random.below(4)) {
    case 0: {
      const double turn = 2.0 * std::numbers::pi;
      return SphericalScanner{columns, rows,
                              random.below(2) == 0 ? turn : uniform(random, 0.1, turn),
                              uniform(random, 0.02, 3.0)};
    }
    case 1:
      return LineStriper{columns, rows, uniform(random, 0.02, 3.0), uniform(random, 0.02, 3.0),
                         0.0};
    default:
      return TiltedLineScan::with_aperture(columns, rows, uniform(random, 0.02, 1.5));
  }
}

/// What a sensor sees from somewhere in the window, by its border too; some ranges are made up, or
/// none.
inline RangeImage random_view(const SmallWorld& w, const SensorGeometry& sensor,
                              RandomStream& random) {
  SensorPose pose;
  for (int axis = 0; axis < 3; ++axis) {
    pose.position_m[axis] = uniform(random, w.corner_m(0)[axis], w.corner_m(1)[axis]);
    if (random.below(6) == 0) {  // beyond the outermost voxel's centre
      const int end = static_cast<int>(random.below(2));
      const double off_m = uniform(random, 0.0, 0.49) * w.grid.voxel_size_m;
      pose.position_m[axis] = w.corner_m(end)[axis] + (end == 0 ? -off_m : off_m);
    }
  }
  pose.pan_rad = uniform(random, -std::numbers::pi, std::numbers::pi);
  pose.tilt_rad = uniform(random, -0.5, 0.5) * std::numbers::pi;
  if (random.below(4) == 0) {  // rays along axes and through the corners of voxels
    pose.position_m = w.grid.center_m(w.grid.voxel_of(pose.position_m));
    pose.pan_rad = 0.5 * std::numbers::pi * uniform_int(random, -2, 2);
    pose.tilt_rad = 0.5 * std::numbers::pi * uniform_int(random, -1, 1);
  }
  RangeLimits limits;
  limits.min_m = random.below(2) == 0 ? 0.0 : 0.3;
  limits.max_m = random.below(3) == 0 ? 1e7 : uniform(random, 0.5, 6.0);
  const double noise_m = random.below(2) == 0 ? 0.0 : 0.02;
  RangeImage image = scan_world(w.world, make_ray_table(sensor), limits, pose, noise_m, &random);
  for (float& range_m : image.range_m) {
    switch (random.below(40)) {
      case 0:
        range_m = std::numeric_limits<float>::quiet_NaN();
        break;
      case 1:
        range_m = std::numeric_limits<float>::infinity();
        break;
      case 2:
        range_m = static_cast<float>(uniform(random, 0.0, 5.0));
        break;
      case 3:
        range_m = random.below(2) == 0 ? 0.0f : 3e38f;
        break;
      default:
        break;
    }
    if (range_m < 0.0f) range_m = 0.0f;
  }
  return image;
}

}  // namespace nextview
