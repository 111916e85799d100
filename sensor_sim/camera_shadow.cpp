#include "sensor_sim/camera_shadow.h"

#include <cmath>
#include <limits>

namespace nextview {

namespace {

// A surface met this much before a point is not the point's own. Distances are floats, and where a
// surface is met at a slant they are as uncertain as they are long.
float slack_m(float reach_m) { return 0.005F + 1e-4F * reach_m; }

}  // namespace

CameraShadow::CameraShadow(const Scene& scene, const RayTable& rays,
                           const Eigen::Matrix3d& world_from_sensor,
                           const Eigen::Vector3d& position_m, double baseline_m)
    : scene_(scene),
      rays_(rays),
      world_from_lines_(rays.world_from_lines(world_from_sensor)),
      light_m_(position_m),
      camera_m_(position_m + baseline_m * world_from_sensor.col(0)),
      hides_(baseline_m > 0.0) {}

void CameraShadow::hide(int first_row, std::span<float> distance_m) {
  if (!hides_) return;
  constexpr auto kLanes = static_cast<std::size_t>(Scene::kPacketSize);
  directions_.resize((distance_m.size() + kLanes - 1) / kLanes);
  distances_.resize(directions_.size());
  reach_m_.resize(distance_m.size());
  const auto columns = static_cast<std::size_t>(rays_.columns());
  const auto look_along = [this](std::size_t i, const Eigen::Vector3d& direction) {
    directions_[i / kLanes].x[i % kLanes] = static_cast<float>(direction.x());
    directions_[i / kLanes].y[i % kLanes] = static_cast<float>(direction.y());
    directions_[i / kLanes].z[i % kLanes] = static_cast<float>(direction.z());
  };
  for (std::size_t i = 0; i < directions_.size() * kLanes; ++i) look_along(i, {0.0, 0.0, 1.0});
  for (std::size_t i = 0; i < distance_m.size(); ++i) {
    reach_m_[i] = std::numeric_limits<float>::quiet_NaN();
    if (!std::isfinite(distance_m[i])) continue;
    const RayRow row = rays_.row(first_row + static_cast<int>(i / columns), world_from_lines_);
    const Eigen::Vector3d ray =
        row.ray(rays_.column_sin[i % columns], rays_.column_cos[i % columns]);
    const Eigen::Vector3d from_camera =
        light_m_ + static_cast<double>(distance_m[i]) * ray - camera_m_;
    const double reach_m = from_camera.norm();
    if (!(reach_m > 0.0)) continue;
    reach_m_[i] = static_cast<float>(reach_m);
    look_along(i, from_camera / reach_m);
  }
  scene_.cast(camera_m_.cast<float>(), directions_, distances_);
  for (std::size_t i = 0; i < distance_m.size(); ++i) {
    const float met_m = distances_[i / kLanes].m[i % kLanes];
    // Nothing is nearer than a reach that is NaN.
    if (met_m < reach_m_[i] - slack_m(reach_m_[i])) {
      distance_m[i] = std::numeric_limits<float>::quiet_NaN();
    }
  }
}

}  // namespace nextview
