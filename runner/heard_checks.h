#pragma once

#include "logger/run_record.h"

namespace nextview {

/// Whether a message can follow on what has been heard of a run, for who looks on and acts on
/// nothing: every message but the first goal was led to by another.
///
/// All throw RejectedMessage for what cannot be, and TooEarly where what would have led to it has
/// not been heard.
void check_follows(const goal_t& goal, const RunRecord& heard);
void check_follows(const search_t& search, const RunRecord& heard);
void check_follows(const arrival_t& arrival, const RunRecord& heard);
void check_follows(const range_image_t& part, const RunRecord& heard);
void check_follows(const commit_t& commit, const RunRecord& heard);
/// Of a planner's end. Those that the run itself says are none.
void check_follows(const stop_t& stop, const RunRecord& heard);
void check_follows(const timing_t& timing, const RunRecord& heard);

}  // namespace nextview
