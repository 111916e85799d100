#pragma once

#include <string_view>

#include "planner/termination.h"

namespace nextview {

/// What ./run returns: 0 for a success, otherwise different for each reason.
int exit_status(StopReason reason);
/// The same for a reason by its name; of a name that no reason has it is 1, as of a run that cannot
/// start: nobody knows whether it is a success.
int exit_status(std::string_view stop_reason);

}  // namespace nextview
