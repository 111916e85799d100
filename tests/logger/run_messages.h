#pragma once

#include <vector>

#include "lcmtypes/channels.h"
#include "logger/run_record.h"

namespace nextview {

/// Messages of a run of 9 views with 3 attempts each, each message valid by itself.
run_config_t config_message();
goal_t goal_of(int view, int attempt);
search_t search_of(int view, int attempt);
arrival_t arrival_of(int view, int attempt, bool arrived);
std::vector<range_image_t> image_of(int view, int attempt);
commit_t commit_of(int view, int attempt);
stop_t stop_after(int views, int final_attempt, const std::string& reason);

/// Adds all messages of a view that the base accepted at an attempt.
void add_view(RunRecord& record, int view, int attempt);

}  // namespace nextview
