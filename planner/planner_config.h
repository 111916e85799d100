#pragma once

#include <memory>

#include "lcmtypes/channels.h"
#include "planner/factors.h"
#include "planner/feasibility.h"
#include "planner/view_planner.h"

namespace nextview {

/// Where the robot of a run may be.
FeasibilityParameters feasibility_of(const run_config_t& config);

/// What the factors count in a run's fitness; nothing unless its strategy goes by it
/// (StrategyFacts::weighs_factors).
FactorWeights factor_weights_of(const run_config_t& config);

/// The planner of a run, with the run's strategy.
/// @throws std::invalid_argument for parameters that cannot be
std::unique_ptr<ViewPlanner> make_view_planner(const run_config_t& config);

}  // namespace nextview
