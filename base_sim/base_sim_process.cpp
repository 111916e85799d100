#include "base_sim/base_sim_process.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "lcmtypes/message_bounds.h"
#include "lcmtypes/parameter_bounds.h"
#include "lcmtypes/rejected_message.h"
#include "lcmtypes/timing_message.h"
#include "scene/scene_config.h"
#include "sensor/sensor_config.h"

namespace nextview {
namespace {

arrival_t arrival_message(const goal_t& goal, const Motion& motion) {
  arrival_t arrival{};
  // However slow the base: the end of time is not gone beyond.
  arrival.utime =
      static_cast<std::int64_t>(std::min(bounds::kTime.most, std::round(motion.duration_s * 1e6)));
  arrival.utime =
      std::min(arrival.utime + goal.utime, static_cast<std::int64_t>(bounds::kTime.most));
  arrival.view = goal.view;
  arrival.attempt = goal.attempt;
  arrival.arrived = motion.arrived;
  for (int axis = 0; axis < 3; ++axis) {
    arrival.true_position_m[axis] = motion.pose.position_m[axis];
    arrival.believed_position_m[axis] = motion.pose.position_m[axis];
  }
  arrival.true_pan_rad = arrival.believed_pan_rad = motion.pose.pan_rad;
  arrival.true_tilt_rad = arrival.believed_tilt_rad = motion.pose.tilt_rad;
  arrival.path_length_m = motion.path_length_m;
  arrival.refusal = motion.refusal;
  return arrival;
}

}  // namespace

BaseLimits base_limits_of(const run_config_t& config) {
  return {.workspace_min_m = Eigen::Vector3d(config.base.workspace_min_m),
          .workspace_max_m = Eigen::Vector3d(config.base.workspace_max_m),
          .lift_min_m = config.base.lift_min_m,
          .lift_max_m = config.base.lift_max_m,
          .base_speed_m_s = config.base.base_speed_m_s,
          .lift_speed_m_s = config.base.lift_speed_m_s,
          .turn_speed_rad_s = config.base.turn_speed_rad_s,
          .body_radius_m = config.base.body_radius_m};
}

BaseSimProcess::BaseSimProcess(Bus& bus, const run_config_t& config,
                               const std::function<bool()>& interrupted, double real_time)
    : bus_(bus),
      scene_(load_scene(config, interrupted)),
      base_(base_limits_of(config), start_pose_of(config), scene_),
      real_time_(real_time) {
  bus_.on<goal_t>([this, config](const goal_t& goal) {
    check_fits_run(config, goal.view, goal.attempt);
    receive(goal);
  });
}

void BaseSimProcess::receive(const goal_t& goal) {
  const MessageKey key = key_of(goal);
  if (key < next_) return;  // carried out
  if (key != next_) {
    // There is no later one before this base has said what became of this one.
    if (key.view <= reached()) throw NotNow();
    throw TooEarly(fmt::format("view {}, attempt {} is ahead of the run: next here is view {}, "
                               "attempt {}",
                               key.view, key.attempt, next_.view, next_.attempt),
                   Channel<goal_t>::name, next_.view, 0, TooEarly::Then::Forget);
  }
  goals_[key] = goal;
}

bool BaseSimProcess::step() {
  if (moved_) {
    if (!real_time_.is_over()) return false;
    publish_moved();
    return true;
  }
  // Where the base is depends on every goal before, so they are carried out in order, whatever the
  // order they come in. A base that was restarted in mid-run asks for the first ones again, gets
  // to the same place and says the same of them as before.
  const auto found = goals_.find(next_);
  if (found == goals_.end()) {
    if (!goals_.empty() && asked_for_ != next_) ask_again();
    return false;
  }
  const goal_t goal = found->second;
  goals_.erase(found);
  move_to(goal);
  return true;
}

void BaseSimProcess::move_to(const goal_t& goal) {
  std::vector<Eigen::Vector3d> waypoints_m;
  for (const auto& waypoint : goal.waypoint_m) waypoints_m.emplace_back(waypoint.data());
  const SensorPose pose{Eigen::Vector3d(goal.position_m), goal.pan_rad, goal.tilt_rad};
  const auto start = std::chrono::steady_clock::now();
  const Motion motion = base_.move(waypoints_m, pose);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  moved_.emplace(
      arrival_message(goal, motion),
      timing_message(bus_.role(), goal.utime, goal.view, goal.attempt, {{"move", wall.count()}}));
  real_time_.begin(motion.duration_s);
  if (real_time_.is_over()) publish_moved();
  next_ = motion.arrived ? MessageKey{.view = goal.view + 1, .attempt = 1}
                         : MessageKey{.view = goal.view, .attempt = goal.attempt + 1};
  if (!motion.arrived && asked_for_view_ == goal.view) asked_for_view_ = 0;  // that was the answer
  bus_.ignore_before<goal_t>(next_.view);
}

void BaseSimProcess::publish_moved() {
  bus_.publish(moved_->first);
  bus_.publish(moved_->second);
  moved_.reset();
}

std::chrono::milliseconds BaseSimProcess::longest_wait() const {
  return moved_ ? real_time_.left() : BusProcess::longest_wait();
}

void BaseSimProcess::ask_again() {
  goals_.erase(goals_.begin(), goals_.lower_bound(next_));  // of attempts that are over
  // Nobody has gone on to a later goal, or waits for what comes of it: there is none to ask for.
  if (!waits()) return;
  bus_.request<goal_t>(next_.view, next_.attempt);
  asked_for_ = next_;
}

void BaseSimProcess::on_missing(const request_t& request) {
  const bool on_the_way = moved_ && moved_->first.view == request.view;
  if (request.wanted_channel == Channel<arrival_t>::name && !on_the_way) {
    asked_for_view_ = std::max(asked_for_view_, request.view);
    bus_.request<goal_t>(request.view, request.attempt);
  }
}

}  // namespace nextview
