#pragma once

#include "lcmtypes/channels.h"
#include "scoring/visible_surface.h"

namespace nextview {

/// Where a robot of this run may be, and what its sensor could see from there.
VisibilityParameters visibility_of(const run_config_t& config);

}  // namespace nextview
