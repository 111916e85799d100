#include "base_sim/base.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "lcmtypes/parameter_bounds.h"
#include "scene/enclosure.h"

namespace nextview {
namespace {

// A position sent over the bus is the same number again; this only forgives its being computed.
constexpr double kSamePlace_m = 1e-6;
// Less than a broom cupboard: nothing a robot could leave.
constexpr double kSmallestRoom_m3 = 2.0;

std::string metres(double value) { return fmt::format("{:.3f}", value); }

std::string place(const Eigen::Vector3d& position_m) {
  return fmt::format("({:.3f}, {:.3f}, {:.3f})", position_m.x(), position_m.y(), position_m.z());
}

// By how much a value lies outside [low, high]; 0 inside.
double excess(double value, double low, double high) {
  return std::max({low - value, value - high, 0.0});
}

// Why the sensor may not be at a position, surfaces aside; empty when it may.
std::string out_of_reach(const BaseLimits& limits, const Eigen::Vector3d& position_m) {
  static constexpr std::array<char, 3> kAxes = {'x', 'y', 'z'};
  if (!position_m.allFinite()) {
    return "a position is not finite";
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double low = limits.workspace_min_m[axis];
    const double high = limits.workspace_max_m[axis];
    if (const double by = excess(position_m[axis], low, high); by > 0.0) {
      return place(position_m) + " lies " + metres(by) + " m outside the workspace, whose " +
             kAxes[static_cast<std::size_t>(axis)] + " goes from " + metres(low) + " to " +
             metres(high);
    }
  }
  if (const double by = excess(position_m.z(), limits.lift_min_m, limits.lift_max_m); by > 0.0) {
    return place(position_m) + " lies " + metres(by) + " m beyond the lift, which goes from " +
           metres(limits.lift_min_m) + " to " + metres(limits.lift_max_m);
  }
  return {};
}

std::string bad_angles(const SensorPose& pose) {
  if (!std::isfinite(pose.pan_rad) || !std::isfinite(pose.tilt_rad)) {
    return "pan or tilt is not finite";
  }
  if (!bounds::kPan.contain(pose.pan_rad)) return bounds::kPan.refusal(pose.pan_rad);
  if (const double by = std::abs(pose.tilt_rad) - bounds::kTilt.most; by > 0.0) {
    return "a tilt of " + metres(pose.tilt_rad * 180.0 / std::numbers::pi) + " degrees is " +
           metres(by * 180.0 / std::numbers::pi) + " degrees beyond +-90";
  }
  return {};
}

// Why the body may not go straight from a to b; names the first place where it would touch.
std::string collision(const Scene& scene, double body_radius_m, const Eigen::Vector3d& a_m,
                      const Eigen::Vector3d& b_m) {
  const double clearance_m = scene.clearance_m(a_m, b_m, body_radius_m);
  if (clearance_m >= body_radius_m) {
    return {};
  }
  // The clearance of the way so far only falls, so the place can be found by halving.
  double free_to = 0.0;
  double touching_at = 1.0;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (free_to + touching_at);
    const bool touches =
        scene.clearance_m(a_m, a_m + middle * (b_m - a_m), body_radius_m) < body_radius_m;
    (touches ? touching_at : free_to) = middle;
  }
  return std::string(kCollision) + "the body would touch a surface at " +
         place(a_m + touching_at * (b_m - a_m)) + " on the way from " + place(a_m) + " to " +
         place(b_m) + ", which leaves " + metres(clearance_m) + " m of the " +
         metres(body_radius_m) + " m it needs";
}

void check(const BaseLimits& limits) {
  for (int axis = 0; axis < 3; ++axis) {
    bounds::kWorkspace.require(limits.workspace_min_m[axis]);
    bounds::kWorkspace.require(limits.workspace_max_m[axis]);
    require_below("workspace_min_m", limits.workspace_min_m[axis], "workspace_max_m",
                  limits.workspace_max_m[axis]);
  }
  bounds::kLift.require(limits.lift_min_m);
  bounds::kLift.require(limits.lift_max_m);
  require_below("lift_min_m", limits.lift_min_m, "lift_max_m", limits.lift_max_m);
  bounds::kBaseSpeed.require(limits.base_speed_m_s);
  bounds::kLiftSpeed.require(limits.lift_speed_m_s);
  bounds::kTurnSpeed.require(limits.turn_speed_rad_s);
  bounds::kBodyRadius.require(limits.body_radius_m);
}

void check_start(const BaseLimits& limits, const SensorPose& start, const Scene& scene) {
  const auto refuse = [&](const std::string& why) {
    throw std::invalid_argument("start position " + place(start.position_m) + ": " + why);
  };
  for (const std::string& why : {out_of_reach(limits, start.position_m), bad_angles(start)}) {
    if (!why.empty()) refuse(why);
  }
  const Eigen::AlignedBox3d bounds = scene.mesh().bounds_m();
  if (!bounds.contains(start.position_m)) {
    refuse("outside the scene, which goes from " + place(bounds.min()) + " to " +
           place(bounds.max()));
  }
  const double clearance_m =
      scene.clearance_m(start.position_m, start.position_m, limits.body_radius_m);
  if (clearance_m < limits.body_radius_m) {
    refuse("too near a surface, " + metres(clearance_m) + " m where the body needs " +
           metres(limits.body_radius_m) + " m");
  }
  const double visible_m3 = visible_volume_m3(scene, start.position_m);
  if (visible_m3 < kSmallestRoom_m3) {
    refuse("inside an obstacle, for only " + metres(visible_m3) + " m3 can be seen from there");
  }
}

double turn_rad(const SensorPose& from, const SensorPose& to) {
  const double pan = std::abs(std::remainder(to.pan_rad - from.pan_rad, 2.0 * std::numbers::pi));
  return std::max(pan, std::abs(to.tilt_rad - from.tilt_rad));
}

}  // namespace

Base::Base(const BaseLimits& limits, const SensorPose& start, const Scene& scene)
    : limits_(limits), pose_(start), scene_(&scene) {
  check(limits);
  check_start(limits, start, scene);
}

Motion Base::move(std::span<const Eigen::Vector3d> waypoints_m, const SensorPose& goal) {
  Motion motion;
  motion.refusal = refusal_of(waypoints_m, goal);
  if (motion.refusal.empty()) {
    for (std::size_t i = 1; i < waypoints_m.size(); ++i) {
      const Eigen::Vector3d way = waypoints_m[i] - waypoints_m[i - 1];
      motion.path_length_m += way.norm();
      motion.duration_s += std::max(way.head<2>().norm() / limits_.base_speed_m_s,
                                    std::abs(way.z()) / limits_.lift_speed_m_s);
    }
    motion.duration_s =
        std::max(motion.duration_s, turn_rad(pose_, goal) / limits_.turn_speed_rad_s);
    motion.arrived = true;
    pose_ = goal;
  }
  motion.pose = pose_;
  return motion;
}

std::string Base::refusal_of(std::span<const Eigen::Vector3d> waypoints_m,
                             const SensorPose& goal) const {
  if (waypoints_m.empty()) {
    return "the path has no waypoints";
  }
  if (std::string why = bad_angles(goal); !why.empty()) {
    return why;
  }
  for (const Eigen::Vector3d& waypoint_m : waypoints_m) {
    if (std::string why = out_of_reach(limits_, waypoint_m); !why.empty()) {
      return why;
    }
  }
  if (const double gap = (waypoints_m.front() - pose_.position_m).norm(); !(gap <= kSamePlace_m)) {
    return "the path starts at " + place(waypoints_m.front()) + ", " + metres(gap) +
           " m from the present position " + place(pose_.position_m);
  }
  if (const double gap = (waypoints_m.back() - goal.position_m).norm(); !(gap <= kSamePlace_m)) {
    return "the path ends at " + place(waypoints_m.back()) + ", " + metres(gap) +
           " m from the goal " + place(goal.position_m);
  }
  for (std::size_t i = 1; i < waypoints_m.size(); ++i) {
    std::string why = collision(*scene_, limits_.body_radius_m, waypoints_m[i - 1], waypoints_m[i]);
    if (!why.empty()) {
      return why;
    }
  }
  return {};
}

}  // namespace nextview
