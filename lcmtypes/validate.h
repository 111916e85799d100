#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lcmtypes/channels.h"

namespace nextview {

/// Whether a decoded message can be right by itself: everything finite that must be, unit vectors
/// and rotations that are ones, sizes that agree, views and attempts from 1, counts not negative.
/// Whether it fits the run (a view beyond the last, say) is for its receiver to judge.
/// @return empty when it can be right, else the reason why not, in one line
std::string check(const run_config_t& config);
std::string check(const goal_t& goal);
std::string check(const search_t& search);
std::string check(const arrival_t& arrival);
std::string check(const range_image_t& image);
std::string check(const commit_t& commit);
std::string check(const stop_t& stop);
std::string check(const status_t& status);
std::string check(const request_t& request);
std::string check(const timing_t& timing);
std::string check(const map_blocks_t& blocks);
std::string check(const pace_t& pace);
std::string check(const parts_request_t& request);
std::string check(const recorded_t& recorded);

/// The names of a comma separated list, as goal_t::factor_names; none of an empty text.
std::vector<std::string_view> names_of(std::string_view list);

}  // namespace nextview
