#pragma once

#include <string>
#include <string_view>

#include "lcmtypes/channels.h"
#include "planner/decision.h"

namespace nextview {

/// A decision as it travels: the goal, and what was tried on the way to it. The keys and
/// utime are left for the sender to fill in.
goal_t goal_message(const Decision& decision);
search_t search_message(const Decision& decision);

/// The value of one of a goal's factors; 0 of one it does not name.
double factor_of(const goal_t& goal, std::string_view name);

/// The goal of view 1: the start pose, where the sensor is already.
goal_t start_goal_message(const SensorPose& start, const std::string& strategy);

/// Why a run ends when the base has refused every goal of a view, for people.
std::string describe_refusals(int view, int attempts, const std::string& last_refusal);

}  // namespace nextview
