#pragma once

#include <Eigen/Core>
#include <numbers>
#include <span>
#include <string>
#include <string_view>

#include "scene/scene.h"
#include "sensor/sensor_pose.h"

namespace nextview {

/// What the robot can do: world frame. The sensor's tilt is always limited to +-90 degrees (P1).
struct BaseLimits {
  Eigen::Vector3d workspace_min_m = Eigen::Vector3d::Zero();  ///< for the sensor's position
  Eigen::Vector3d workspace_max_m = Eigen::Vector3d::Zero();
  double lift_min_m = 0.2;  ///< lowest z of the sensor
  double lift_max_m = 2.8;  ///< highest z of the sensor
  double base_speed_m_s = 0.5;
  double lift_speed_m_s = 0.2;
  double turn_speed_rad_s = std::numbers::pi / 4.0;  ///< of pan and of tilt
  double body_radius_m = 0.20;                       ///< a sphere about the sensor
};

/// What a refusal begins with when the body would have touched something; other bases' too.
inline constexpr std::string_view kCollision = "collision: ";

/// How a motion ended. When it was refused the robot has not moved at all.
struct Motion {
  bool arrived = false;
  std::string refusal;  ///< why not, for people: where and by how much; empty when arrived
  SensorPose pose;      ///< after the motion
  double path_length_m = 0.0;
  double duration_s = 0.0;  ///< simulated
};

/// A mobile base with lift, pan and tilt (P7), whose body is checked against the CAD.
class Base {
 public:
  /// The scene must outlive the base.
  /// @throws std::invalid_argument for limits that cannot be; for a start outside them, outside the
  /// scene, inside an obstacle or nearer to one than the body's radius; the message says where and
  /// by how much
  Base(const BaseLimits& limits, const SensorPose& start, const Scene& scene);

  /// Moves along straight pieces from waypoint to waypoint and turns to the goal's pan (the short
  /// way round) and tilt meanwhile. The first waypoint must be the present position and the last
  /// the goal's, to a micrometre. Every piece takes as long as the slower of base (horizontal) and
  /// lift (vertical). All of it is checked before anything moves.
  Motion move(std::span<const Eigen::Vector3d> waypoints_m, const SensorPose& goal);

  const SensorPose& pose() const { return pose_; }

 private:
  std::string refusal_of(std::span<const Eigen::Vector3d> waypoints_m,
                         const SensorPose& goal) const;

  BaseLimits limits_;
  SensorPose pose_;
  const Scene* scene_;
};

}  // namespace nextview
