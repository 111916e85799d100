#pragma once

#include <set>

#include "lcmtypes/bus.h"
#include "logger/run_log.h"
#include "runner/heard_run.h"

namespace nextview {

/// Asks whoever published it for a message, so that it comes once more.
void request(Bus& bus, const MissingMessage& missing);

/// What has been heard, or must have been said, and is not in the log.
std::set<MissingMessage> lacking_in_log(const RunRecord& logged, const RunRecord& heard);

/// Reads what the recorder still writes of a run that ends early, and asks for what it lacks: the
/// view under way still counts. Ends when all is there, or nothing more comes.
void read_log_to_its_end(RunLog& log, Bus& bus, const HeardRun& heard);

/// Publishes an end of the run and waits until it is in the log, for a second at most.
void publish_into_log(const stop_t& stop, RunLog& log, Bus& bus);

}  // namespace nextview
