#pragma once

#include <ostream>

#include "logger/recovered_run.h"

namespace nextview {

/// Tells a run as MCAP with Foxglove's well-known schemas: see exporter/README.md for its topics.
void write_run_mcap(std::ostream& out, const RecoveredRun& run);

}  // namespace nextview
