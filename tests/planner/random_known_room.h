#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <numbers>

#include "mapper/map_builder.h"
#include "sensor/sensor_geometry.h"
#include "tests/mapper/analytic_world.h"

namespace nextview {

/// A state of a map as runs come upon them: a random room with boxes and maybe a ball in it, of
/// which 1 to 25 scans of the paper's sensor are known, and a place in it where the map is Empty.
class RandomKnownRoom {
 public:
  static constexpr double kVoxel_m = 0.1;

  explicit RandomKnownRoom(std::int64_t seed)
      : random_(seed, 1, 1, RandomPurpose::InitialSimplex),
        builder_({kVoxel_m}, {{-2, -2, -2}, {66, 56, 36}}) {
    size_m_ = {uniform(random_, 3.0, 6.0), uniform(random_, 3.0, 5.0), uniform(random_, 2.2, 3.0)};
    world_.boxes.push_back({Eigen::Vector3d::Zero(), size_m_});
    for (int boxes = uniform_int(random_, 1, 6); boxes > 0; --boxes) add_box();
    if (random_.below(3) == 0) add_ball();
    const RayTable rays = make_ray_table(TiltedLineScan::paper());
    for (int scans = uniform_int(random_, 1, 25); scans > 0; --scans) {
      SensorPose pose;
      pose.position_m = free_position_m();
      pose.pan_rad = uniform(random_, -std::numbers::pi, std::numbers::pi);
      pose.tilt_rad = uniform(random_, -0.7, 0.7);
      builder_.fold(scan_world(world_, rays, RangeLimits(), pose));
    }
    do {
      position_m_ = free_position_m();
    } while (map().label(map().grid().voxel_of(position_m_)) != Label::Empty);
  }

  const VoxelMap& map() const { return builder_.map(); }
  const Eigen::Vector3d& position_m() const { return position_m_; }

 private:
  void add_box() {
    const Eigen::Vector3d extent(uniform(random_, 0.2, 1.2), uniform(random_, 0.2, 1.2),
                                 uniform(random_, 0.3, 2.2));
    const double x = uniform(random_, 0.0, size_m_.x() - extent.x());
    const double y = uniform(random_, 0.0, size_m_.y() - extent.y());
    const bool stands = random_.below(10) < 7;
    const double z = stands ? 0.0 : uniform(random_, 0.0, size_m_.z() - extent.z());
    world_.boxes.push_back({{x, y, z}, Eigen::Vector3d(x, y, z) + extent});
  }
  void add_ball() {
    const double x = uniform(random_, 0.5, size_m_.x() - 0.5);
    const double y = uniform(random_, 0.5, size_m_.y() - 0.5);
    const double z = uniform(random_, 0.5, 1.8);
    world_.spheres.push_back({{x, y, z}, uniform(random_, 0.2, 0.5)});
  }

  bool is_free(const Eigen::Vector3d& p) const {
    constexpr double kDistance_m = 0.15;
    const auto in_box = [&](const AnalyticWorld::Box& box) {
      return ((p - box.min_m).array() > -kDistance_m).all() &&
             ((box.max_m - p).array() > -kDistance_m).all();
    };
    return std::none_of(world_.boxes.begin() + 1, world_.boxes.end(), in_box) &&
           std::ranges::none_of(world_.spheres, [&](const AnalyticWorld::Sphere& ball) {
             return (p - ball.center_m).norm() < ball.radius_m + kDistance_m;
           });
  }
  Eigen::Vector3d free_position_m() {
    for (;;) {
      Eigen::Vector3d p;
      for (int axis = 0; axis < 3; ++axis) p[axis] = uniform(random_, 0.3, size_m_[axis] - 0.3);
      if (is_free(p)) return p;
    }
  }

  RandomStream random_;
  AnalyticWorld world_;
  Eigen::Vector3d size_m_;
  MapBuilder builder_;
  Eigen::Vector3d position_m_;
};

}  // namespace nextview
