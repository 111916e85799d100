#pragma once

#include <functional>
#include <map>
#include <optional>

#include "base_sim/base.h"
#include "lcmtypes/bus_process.h"
#include "scene/scene.h"

namespace nextview {

/// What the base of a run can do.
BaseLimits base_limits_of(const run_config_t& config);

/// The simulated base on the bus: an arrival, or a refusal, for every goal.
class BaseSimProcess : public BusProcess {
 public:
  /// @throws SceneError when the run's scene cannot be loaded; std::invalid_argument when the run
  ///         cannot start where it should
  /// @param interrupted  when to give up loading it, as in LoadLimits
  BaseSimProcess(Bus& bus, const run_config_t& config,
                 const std::function<bool()>& interrupted = {});

  /// Moves to the next goal.
  bool step() override;
  /// Asks for the next goal, when later ones have come, or must have before it was started.
  void ask_again() override;
  bool behind() const override { return next_.view <= reached(); }
  void on_missing(const request_t& request) override;

 private:
  Bus& bus_;
  Scene scene_;
  Base base_;
  std::map<MessageKey, goal_t> goals_;  ///< still to be carried out
  MessageKey next_{.view = 1, .attempt = 1};
  MessageKey asked_for_;
};

}  // namespace nextview
