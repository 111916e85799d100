#pragma once

#include "logger/run_log.h"

namespace nextview {

/// Puts the seal (seal_t) behind the last event of a run's log, for replays to see what was lost or
/// changed since. Does nothing to a log that has no end (stop_t) yet, or has its seal. Nobody may
/// be writing.
/// @param log read to its end, in one file
/// @throws LogError when the file cannot be changed; then it is as it was
void seal_log(const RunLog& log);

}  // namespace nextview
