#pragma once

#include "lcmtypes/channels.h"

namespace nextview {

/// A small valid message of every type.
template <class Message>
Message example();

template <>
run_config_t example();
template <>
goal_t example();
template <>
search_t example();
template <>
arrival_t example();
template <>
range_image_t example();
template <>
commit_t example();
template <>
stop_t example();
template <>
status_t example();
template <>
request_t example();
template <>
timing_t example();
template <>
map_blocks_t example();
template <>
pace_t example();
template <>
parts_request_t example();
template <>
recorded_t example();

}  // namespace nextview
