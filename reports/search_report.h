#pragma once

#include <ostream>

#include "logger/run_record.h"

namespace nextview {

/// What a view was decided on, as JSON (paper figure 6), for whoever draws or counts it: the points
/// of the range image taken where the search began, the positions that were tried with the best
/// direction and fitness at each, the goal, and of which run it is. Metres, degrees, world frame.
/// @param record of a log that was read with RangeImages::Keep
/// @param view the view that was decided on, from 2; its attempt is the one that arrived
/// @throws std::invalid_argument saying what the log lacks for it
void write_search(std::ostream& out, const RunRecord& record, int view);

/// The committed view, from 2 to last_view, for which most positions were tried, the first of
/// several: the one that shows most of how a search goes. 0 when no goal was searched for.
int largest_search(const RunRecord& record, int last_view);

}  // namespace nextview
