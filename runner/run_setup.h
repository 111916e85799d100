#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "lcmtypes/channels.h"
#include "runner/run_options.h"
#include "scene/scene.h"
#include "scoring/view_bound.h"
#include "scoring/visibility_config.h"

namespace nextview {

/// A run that cannot start; the message names the file or option and says what to do.
class SetupError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Everything a run needs to know before its first process starts.
struct RunSetup {
  run_config_t config{};               ///< without the run's number
  std::shared_ptr<const Scene> scene;  ///< for the scoring only; null when there is none
  /// That nextview_mapper is started with: of what has no influence on the map.
  std::vector<std::string> mapper_options;
  std::vector<std::string> notes;     ///< for the user: what was worked out for the run
  std::vector<std::string> warnings;  ///< for the user
};

/// Loads the scene, unless there are no simulators, and turns options into the run's configuration,
/// everything checked.
/// @throws SetupError, or SceneError where the scene itself cannot be used
RunSetup prepare_run(const RunOptions& options);

/// Fills in what the mapper is told of the window that options give it (--window), which a run's
/// configuration does not hold.
void fill_window(RunSetup& setup, const RunOptions& options);

/// The question how few views a scene takes, for this run's sensor and start.
ViewBoundQuestion bound_question_of(const RunOptions& options, const run_config_t& config);

}  // namespace nextview
