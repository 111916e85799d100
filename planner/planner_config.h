#pragma once

#include <memory>

#include "lcmtypes/channels.h"
#include "planner/next_view.h"
#include "planner/prediction/view_predictor.h"
#include "planner/termination.h"

namespace nextview {

/// How the planner of a run searches, and when it has seen enough.
PlannerParameters planner_parameters_of(const run_config_t& config);
StopParameters stop_parameters_of(const run_config_t& config);

/// The predictor a run's views are evaluated with: every ray of every orientation, or with more
/// than 20 orientations and quality off one panorama that answers them all.
std::unique_ptr<ViewPredictor> make_predictor(const run_config_t& config);

/// The pose of view 1.
SensorPose start_pose_of(const run_config_t& config);

}  // namespace nextview
