#pragma once

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>

#include "lcmtypes/run_key.h"
#include "viewer/viewed_run.h"

namespace nextview {

/// Follows a run that is being recorded or has been, until asked to stop: works through the log,
/// and waits for more while it holds no end of the run.
/// @param folder_or_log as log_file_of has it
/// @throws LogError when there is no log; what else fails is said in the run's note
void follow_log(const std::string& folder_or_log, ViewedRun& viewed, const std::stop_token& stop);

/// Follows a run on the bus, as one of its clients, until asked to stop. What it has missed, and
/// all of a run that is under way already, it asks for, a view at a time. Publishes the pace
/// (pace_t) that the page sets.
/// @param lcm_url as Bus has it
/// @param run its number; 0: that of the first message heard
/// @param key of the run, without whose signature no message is taken; nothing: it has none
/// @throws BusError when the bus does not work here
void follow_bus(const std::string& lcm_url, std::int64_t run, const std::optional<RunKey>& key,
                ViewedRun& viewed, const std::stop_token& stop);

}  // namespace nextview
