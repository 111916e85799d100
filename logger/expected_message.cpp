#include "logger/expected_message.h"

#include <algorithm>
#include <cmath>

#include "planner/goal_message.h"
#include "sensor/range_image_check.h"
#include "sensor/sensor_config.h"

namespace nextview {
namespace {

/// Copies what names a message, and no decision tells.
template <class Message>
Message with_key_of(const Message& logged, Message message, std::int64_t utime) {
  message.utime = utime;
  message.run = logged.run;
  message.view = logged.view;
  message.attempt = logged.attempt;
  return message;
}

double path_length_m(const goal_t& goal) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < goal.waypoint_m.size(); ++i) {
    length_m += (Eigen::Vector3d(goal.waypoint_m[i].data()) -
                 Eigen::Vector3d(goal.waypoint_m[i - 1].data()))
                    .norm();
  }
  return length_m;
}

void put_position(double (&field_m)[3], const Eigen::Vector3d& position_m) {
  std::copy_n(position_m.data(), 3, field_m);
}

void put_waypoint(std::vector<double>& field_m, const Eigen::Vector3d& position_m) {
  field_m.assign(position_m.data(), position_m.data() + 3);
}

/// The same but for the last bits, in which sines differ between machines, or for those that a
/// number of 32 bits does not have.
bool near(double a, double b) {
  return std::abs(a - b) <= kUnitTolerance * std::max({1.0, std::abs(a), std::abs(b)});
}
bool near(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](double x, double y) { return near(x, y); });
}

/// Whether an image says the pose the robot took itself to be in when it had arrived.
bool is_pose_of(const RangeImage& image, const arrival_t& arrival, bool to_the_last_bit) {
  const auto same = [to_the_last_bit](double a, double b) {
    return to_the_last_bit ? a == b : near(a, b);
  };
  return std::equal(image.position_m.begin(), image.position_m.end(), arrival.believed_position_m,
                    same) &&
         same(image.pose.pan_rad, arrival.believed_pan_rad) &&
         same(image.pose.tilt_rad, arrival.believed_tilt_rad);
}

std::int64_t scan_duration_us(const run_config_t& config) {
  return std::llround(config.sensor.scan_duration_s * 1e6);
}

}  // namespace

Simulated simulated_in(const RunRecord& run) {
  return {run.roles().contains("base_sim"), run.roles().contains("sensor_sim")};
}

goal_t expected_start_goal(const goal_t& logged, const run_config_t& config) {
  return with_key_of(logged, start_goal_message(start_pose_of(config), config.strategy), 0);
}

goal_t expected_goal(const goal_t& logged, const Decision& decision, std::int64_t utime) {
  return with_key_of(logged, goal_message(decision), utime);
}

goal_t expected_goal(const goal_t& logged, const run_config_t& config,
                     const Eigen::Vector3d* present_m, std::int64_t utime) {
  goal_t goal = logged;
  goal.utime = utime;
  if (present_m != nullptr) put_waypoint(goal.waypoint_m.front(), *present_m);
  put_waypoint(goal.waypoint_m.back(), Eigen::Vector3d(goal.position_m));
  goal.path_length_m = path_length_m(goal);
  goal.strategy = config.strategy;
  return goal;
}

search_t expected_search(const search_t& logged, const Decision& decision, std::int64_t utime) {
  return with_key_of(logged, search_message(decision), utime);
}

arrival_t expected_arrival(const arrival_t& logged, const goal_t& goal, bool arrived,
                           const SensorPose& before, bool simulated) {
  arrival_t arrival = logged;
  arrival.arrived = arrived ? 1 : 0;
  if (arrived) arrival.refusal.clear();
  arrival.utime = std::max(arrival.utime, goal.utime);
  if (!simulated) return arrival;
  SensorPose pose = before;
  if (arrived) pose = {Eigen::Vector3d(goal.position_m), goal.pan_rad, goal.tilt_rad};
  put_position(arrival.true_position_m, pose.position_m);
  put_position(arrival.believed_position_m, pose.position_m);
  arrival.true_pan_rad = arrival.believed_pan_rad = pose.pan_rad;
  arrival.true_tilt_rad = arrival.believed_tilt_rad = pose.tilt_rad;
  arrival.path_length_m = arrived ? path_length_m(goal) : 0.0;
  if (!arrived) arrival.utime = goal.utime;
  return arrival;
}

std::vector<std::string> contradictions_of(const ReceivedRangeImage& received,
                                           const arrival_t& arrival, const run_config_t& config,
                                           bool simulated) {
  const RangeImage& image = received.image;
  std::vector<std::string> found;
  const auto demand = [&found](bool holds, const std::string& what) {
    if (!holds) found.push_back(what);
  };
  demand(is_pose_of(image, arrival, simulated), "its pose is not the one the robot arrived at");
  demand(received.utime >= arrival.utime, "it was taken before the robot arrived");
  if (!simulated) return found;
  const RayTable rays = make_ray_table(sensor_of(config));
  demand(image.rays.kind == rays.kind, "its geometry is not the configured one");
  demand(image.rays.columns() == rays.columns() && image.rays.rows() == rays.rows(),
         "its raster is not the configured one");
  demand(near(image.rays.column_sin, rays.column_sin) &&
             near(image.rays.column_cos, rays.column_cos) &&
             near(image.rays.row_sin, rays.row_sin) && near(image.rays.row_cos, rays.row_cos),
         "its rays are not those of the configured sensor");
  demand(image.limits.min_m == config.sensor.range_min_m &&
             image.limits.max_m == config.sensor.range_max_m,
         "its limits of range are not the configured ones");
  demand(image.world_from_sensor.isApprox(
             world_from_sensor_rotation(image.pose.pan_rad, image.pose.tilt_rad), kUnitTolerance),
         "its rotation is not that of its pan and tilt");
  demand(received.utime == arrival.utime + scan_duration_us(config),
         "it was not taken as long after the arrival as a scan takes");
  return found;
}

}  // namespace nextview
