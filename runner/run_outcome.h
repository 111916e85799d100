#pragma once

#include <optional>

#include "logger/run_record.h"
#include "reports/run_report.h"
#include "runner/ends_early.h"

namespace nextview {

/// Counts the goals that the base refused, those because its body would have touched something
/// apart.
void count_refusals(const RunRecord& record, FinishedRun& run);

/// Writes down why a run has ended: as its log says it, or why it did not get to its end. The log
/// is not contradicted without a word, and a reason that is none of ours gets a sentence of its
/// own.
/// @param record of the run, which holds its stop unless it ended early
/// @param early why it did not get to its own end; nothing when it did
void tell_end(const RunRecord& record, const std::optional<EndsEarly>& early, FinishedRun& run);

}  // namespace nextview
