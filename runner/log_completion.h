#pragma once

#include <optional>
#include <set>

#include "lcmtypes/bus.h"
#include "logger/run_log.h"
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

/// Reads what the recorder still writes of a run that ends early, and has what it lacks published
/// again: the view under way still counts. Ends when all is there, or nothing more comes.
void read_log_to_its_end(RunLog& log, Bus& bus, const HeardRun& heard);

/// The end that is to be published so that the log of a run that ended early says how it ended.
/// There is one end only: another one would contradict it.
/// @param recorded the end in the log, if there is one: then nothing is published
/// @param heard the end that was heard here: then the same again, which its planner says no more
/// @param own what to say when nobody has ended the run
std::optional<stop_t> end_to_publish(const std::optional<stop_t>& recorded,
                                     const std::optional<stop_t>& heard, const stop_t& own);

/// Publishes an end of the run until it is in the log, for two seconds at most.
void publish_into_log(const stop_t& stop, RunLog& log, Bus& bus);

}  // namespace nextview
