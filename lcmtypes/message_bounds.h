#pragma once

#include "lcmtypes/parameter_bounds.h"

/// What a message can say that no parameter gives.
namespace nextview::bounds {

/// Where a robot can say that it is, or is to go: a workspace and as much about it.
inline constexpr Bounds kPlace{"a place, m", 2.0 * kWorkspace.least, 2.0 * kWorkspace.most};
/// Simulated microseconds. Above it there is room for what is added to one.
inline constexpr Bounds kTime{"utime", 0.0, 4e18};

}  // namespace nextview::bounds
