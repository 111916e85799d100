#pragma once

#include <string>
#include <vector>

#include "logger/run_log.h"

namespace nextview {

struct ReplayOptions {
  bool planner = false;  ///< decide every goal again, too
};

/// What came of a replay.
struct ReplayReport {
  int views = 0;             ///< whose map was rebuilt and had the digest that was committed
  int goals = 0;             ///< decided again, and found the same
  std::string stop_reason;   ///< of the run, from its log
  std::string disagreement;  ///< the first thing that differs or is missing; empty: all agrees
};

/// Rebuilds a run's map from its log alone: folds the range images with the mapper's own library
/// and holds the map's digest after every view against the commit's. With `planner`, also decides
/// every goal again with the planner's own library, which must give the same, bit for bit.
/// @param log read to its end, range images kept
ReplayReport replay(const RunLog& log, const ReplayOptions& options);

}  // namespace nextview
