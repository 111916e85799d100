#pragma once

#include <string>
#include <vector>

#include "lcmtypes/channels.h"
#include "logger/run_record.h"
#include "planner/decision.h"
#include "sensor/range_image_message.h"
#include "sensor/sensor_pose.h"

namespace nextview {

/// What messages of a log must say, given what came before them: each function takes a message as
/// it was logged and returns it with every field put right that can be told. What differs between
/// the two is wrong in the log.

/// Which of base and sensor were simulated. A simulated base goes exactly where it is sent, a
/// simulated sensor is the configured one; a driver in the place of one of them is believed.
struct Simulated {
  bool base = false;
  bool sensor = false;
};

/// As the simulators themselves have said: each publishes its status, by its role, before a run has
/// its first goal, and a driver has a name of its own.
Simulated simulated_in(const RunRecord& run);

/// The goal of view 1: the scan at the start.
goal_t expected_start_goal(const goal_t& logged, const run_config_t& config);
/// A goal that was decided again.
goal_t expected_goal(const goal_t& logged, const Decision& decision, std::int64_t utime);
/// A goal that was not: only how its path starts, leads and ends.
/// @param present position of the view before; nullptr when it is not known
goal_t expected_goal(const goal_t& logged, const run_config_t& config,
                     const Eigen::Vector3d* present_m, std::int64_t utime);

search_t expected_search(const search_t& logged, const Decision& decision, std::int64_t utime);

/// @param arrived whether it is the attempt after which a view was taken
/// @param before pose of the view before, where a robot that refuses still is
/// @param simulated whether a simulated base says so, of whom all is known
arrival_t expected_arrival(const arrival_t& logged, const goal_t& goal, bool arrived,
                           const SensorPose& before, bool simulated);

/// What a range image contradicts of the configuration and the arrival it was taken after, one line
/// each.
/// @param simulated whether the simulated sensor took it. A driver's must agree with the arrival to
///        kUnitTolerance, as numbers of 32 bits do.
std::vector<std::string> contradictions_of(const ReceivedRangeImage& received,
                                           const arrival_t& arrival, const run_config_t& config,
                                           bool simulated);

}  // namespace nextview
