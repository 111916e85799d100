#pragma once

#include <optional>
#include <set>

#include "lcmtypes/bus.h"
#include "logger/run_log.h"
#include "runner/ends_early.h"
#include "runner/heard_run.h"

namespace nextview {

/// Asks whoever published it for a message, so that it comes once more; of a range image for the
/// parts that are not here.
void request(Bus& bus, const MissingMessage& missing, const RunRecord& here);

/// What has been heard, or must have been said, and is not in the log.
std::set<MissingMessage> lacking_in_log(const RunRecord& logged, const RunRecord& heard);

/// Publishes once more what has been heard here, the same bytes: whoever said it may be no more.
/// @return false when it is not here, or is a range image, of which only the pixels are kept
bool publish_again(Bus& bus, const MissingMessage& missing, const RunRecord& heard);

/// The end that is to be published so that the log of a run that ended early says how it ended.
/// There is one end only: another one would contradict it.
/// @param recorded the end in the log, if there is one: then nothing is published
/// @param heard the end that was heard here: then the same again, which its planner says no more
/// @param own what to say when nobody has ended the run
std::optional<stop_t> end_to_publish(const std::optional<stop_t>& recorded,
                                     const std::optional<stop_t>& heard, const stop_t& own);

/// Has the log of a run that ends early say so: reads what the recorder still writes, has what it
/// lacks published again, since the view under way still counts, and publishes the end until it is
/// in the log, for two seconds at most.
/// @param heard takes the end that is in the log, if it was missed here
void log_early_end(const EndsEarly& end, RunLog& log, Bus& bus, HeardRun& heard);

}  // namespace nextview
