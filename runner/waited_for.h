#pragma once

#include <string>
#include <vector>

#include "runner/heard_run.h"

namespace nextview {

/// Whom a run waits for that does not get on, and what for: "the mapper did not commit the range
/// image of view 3".
/// @param answering the roles the run has started a process for; a driver stands in for the others
std::string waited_for(const HeardRun& heard, const std::vector<std::string>& answering);

/// What the motion and the scan under way may take without a word, in seconds by the clock.
/// @param real_time how many times as fast as they simulate; 0: they take no time
double watched_motion_s(const RunRecord& record, const run_config_t& config, double real_time);

}  // namespace nextview
