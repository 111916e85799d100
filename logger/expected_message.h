#pragma once

#include <string>
#include <vector>

#include "lcmtypes/channels.h"
#include "planner/decision.h"
#include "sensor/range_image_message.h"
#include "sensor/sensor_pose.h"

namespace nextview {

/// What messages of a log must say, given what came before them: each function takes a message as
/// it was logged and returns it with every field put right that can be told. What differs between
/// the two is wrong in the log.

/// Whether base and sensor of a run were simulated, so that the one drives exactly and the other
/// is the configured one. A run with a real robot has no scene.
bool is_simulated(const run_config_t& config);

/// The goal of view 1: the scan at the start.
goal_t expected_start_goal(const goal_t& logged, const run_config_t& config);
/// A goal that was decided again; factors of value 0 only as far as the log names them.
goal_t expected_goal(const goal_t& logged, const Decision& decision, std::int64_t utime);
/// A goal that was not: only how its path starts, leads and ends.
/// @param present position of the view before; nullptr when it is not known
goal_t expected_goal(const goal_t& logged, const run_config_t& config,
                     const Eigen::Vector3d* present_m, std::int64_t utime);

search_t expected_search(const search_t& logged, const Decision& decision, std::int64_t utime);

/// @param arrived whether it is the attempt after which a view was taken
/// @param before pose of the view before, where a robot that refuses still is
arrival_t expected_arrival(const arrival_t& logged, const goal_t& goal, bool arrived,
                           const SensorPose& before, bool simulated);

/// What a range image contradicts of the configuration and the arrival it was taken after, one line
/// each.
std::vector<std::string> contradictions_of(const ReceivedRangeImage& received,
                                           const arrival_t& arrival, const run_config_t& config);

}  // namespace nextview
