#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <vector>

#include "logger/run_log.h"
#include "mapper/map_builder.h"

namespace nextview {

/// A run as its log tells it: its messages, its range images in view order, and the map they make.
struct RecoveredRun {
  RunLog log;
  std::vector<const ReceivedRangeImage*> images;  ///< of view 1, 2, ..., held by the log
  MapBuilder builder;

  const run_config_t& config() const { return *log.record().config(); }
};

/// Folds the range images of a log as mapper and planner did, up to the first view that is not
/// whole or until so many have been folded.
/// @param folder_or_log see log_file_of
/// @param run which run, when the log holds several; nothing: the first one
/// @throws LogError naming the file when it cannot be read, holds no run or no whole view, or when
///         the map is not the one the run had
RecoveredRun recover_run(const std::filesystem::path& folder_or_log,
                         std::optional<std::int64_t> run = std::nullopt,
                         int max_views = std::numeric_limits<int>::max());

/// The log that is meant by the folder of a run, or by a log itself.
/// @throws LogError when there is neither
std::filesystem::path log_file_of(const std::filesystem::path& folder_or_log);

/// The files of that log in the order in which they were recorded: itself, or where there is none
/// the parts that lcm-logger has left with --rotate (NAME.0 is the latest) or -i (NAME.00 is the
/// first).
std::vector<std::filesystem::path> log_files_of(const std::filesystem::path& folder_or_log);

}  // namespace nextview
