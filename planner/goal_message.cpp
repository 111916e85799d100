#include "planner/goal_message.h"

#include <algorithm>

#include "lcmtypes/validate.h"

namespace nextview {
namespace {

goal_t goal_at(const SensorPose& pose, std::span<const Eigen::Vector3d> waypoints_m) {
  goal_t goal{};
  for (int axis = 0; axis < 3; ++axis) goal.position_m[axis] = pose.position_m[axis];
  goal.pan_rad = pose.pan_rad;
  goal.tilt_rad = pose.tilt_rad;
  goal.waypoints = static_cast<std::int32_t>(waypoints_m.size());
  for (const Eigen::Vector3d& waypoint_m : waypoints_m) {
    goal.waypoint_m.push_back({waypoint_m.x(), waypoint_m.y(), waypoint_m.z()});
  }
  goal.path_length_m = travel_along(waypoints_m).length_m;
  return goal;
}

}  // namespace

goal_t goal_message(const Decision& decision) {
  goal_t goal = goal_at(decision.pose, decision.waypoints_m);
  goal.fitness = decision.fitness.value;
  goal.share_occupied = decision.fitness.share_occupied;
  goal.share_occlusion_plane = decision.fitness.share_occlusion_plane;
  goal.share_unseen = decision.fitness.share_unseen;
  goal.share_open = decision.fitness.share_open;
  for (std::size_t i = 0; i < kFactors.size(); ++i) {
    goal.factor_value.push_back(decision.fitness.factors[i]);
    if (i > 0) goal.factor_names += ',';
    goal.factor_names += kFactors[i].name;
  }
  goal.factors = static_cast<std::int32_t>(goal.factor_value.size());
  goal.strategy = decision.strategy;
  goal.reason = decision.reason;
  goal.expected_gain_m2 = decision.expected_gain_m2;
  goal.overlap = decision.overlap;
  goal.iterations = decision.iterations;
  goal.evaluations = decision.evaluations;
  return goal;
}

double factor_of(const goal_t& goal, std::string_view name) {
  const std::vector<std::string_view> names = names_of(goal.factor_names);
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return 0.0;
  return goal.factor_value[static_cast<std::size_t>(found - names.begin())];
}

search_t search_message(const Decision& decision) {
  search_t search{};
  search.tried = static_cast<std::int32_t>(decision.tried.size());
  for (const TriedPosition& tried : decision.tried) {
    search.tried_position_m.push_back(
        {tried.position_m.x(), tried.position_m.y(), tried.position_m.z()});
    search.tried_pan_rad.push_back(tried.pan_rad);
    search.tried_tilt_rad.push_back(tried.tilt_rad);
    search.tried_fitness.push_back(tried.fitness);
    search.tried_move.push_back(static_cast<std::int8_t>(tried.move));
  }
  return search;
}

goal_t start_goal_message(const SensorPose& start, const std::string& strategy) {
  goal_t goal = goal_at(start, std::span(&start.position_m, 1));
  goal.strategy = strategy;
  goal.reason = "the scan at the start";
  return goal;
}

std::string describe_refusals(int view, int attempts, const std::string& last_refusal) {
  return "view " + std::to_string(view) + ": the base refused " + std::to_string(attempts) +
         " goals, the last one because " + last_refusal;
}

}  // namespace nextview
