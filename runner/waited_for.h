#pragma once

#include <string>
#include <vector>

#include "runner/heard_run.h"

namespace nextview {

/// Whom a run waits for that does not get on, and what for: "the mapper did not commit the range
/// image of view 3".
/// @param answering the roles the run has started a process for; a driver stands in for the others
std::string waited_for(const HeardRun& heard, const std::vector<std::string>& answering);

}  // namespace nextview
