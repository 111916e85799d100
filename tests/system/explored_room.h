#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "planner/view_planner.h"
#include "runner/run_setup.h"

namespace nextview {

/// One of our own rooms, with the default options of a run.
RunSetup room_setup(const std::string& room, const std::string& strategy, std::int64_t seed,
                    int views);

/// Called after every view: the planner, what the view has changed, and its image.
using ViewTaken = std::function<void(const ViewPlanner& planner, const FoldReport& fold,
                                     const RangeImage& image)>;

/// Explores a room without a bus: planner, base and sensor one after the other, as the processes of
/// a run do it, until the planner ends it.
void explore(const RunSetup& setup, const ViewTaken& view_taken);

}  // namespace nextview
