#pragma once

#include <optional>
#include <string>
#include <vector>

#include "logger/run_log.h"

namespace nextview {

struct ReplayOptions {
  bool planner = false;  ///< decide every goal again, too
  /// Threads to decide with, in place of the run's; of no influence on the results.
  std::optional<int> threads = std::nullopt;
};

/// What came of a replay.
struct ReplayReport {
  int views = 0;            ///< folded again, and everything the mapper committed was the same
  int goals = 0;            ///< decided again, and the same, with all that was tried
  std::string stop_reason;  ///< of the run, from its log
  std::vector<std::string> differences;  ///< what the log says and is not so, one line each
  std::vector<std::string> missing;      ///< what the log lacks, so that less could be checked
  std::vector<std::string> remarks;      ///< what else there is, and is no fault
  bool sealed = false;                   ///< the log bears its seal (seal_t)

  /// 0 when all of it agrees, 1 when something differs, 3 when what is there agrees and something
  /// is missing. A log without a view has nothing to agree to.
  int exit_status() const { return !differences.empty() ? 1 : !missing.empty() ? 3 : 0; }
};

/// Replays a run from its log alone. Folds every range image the log holds with the mapper's own
/// library and works out again every field that can be: commits from the fold, arrivals from goals,
/// poses from arrivals, goals and searches (with `planner`) from the map with the planner's own
/// library, the end of the run from all of them. What a log says must be the same, bit for bit.
/// Which fields are not checked, unchecked_fields() says.
/// @param log read to its end, range images kept
ReplayReport replay(const RunLog& log, const ReplayOptions& options);

}  // namespace nextview
