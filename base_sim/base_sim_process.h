#pragma once

#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "base_sim/base.h"
#include "lcmtypes/bus_process.h"
#include "lcmtypes/real_time.h"
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
  /// @param real_time  simulated seconds a second; 0: at once
  BaseSimProcess(Bus& bus, const run_config_t& config,
                 const std::function<bool()>& interrupted = {}, double real_time = 0.0);

  /// Moves to the next goal, or says that it is there.
  bool step() override;
  std::chrono::milliseconds longest_wait() const override;
  /// Asks for the next goal, when later ones have come, or must have before it was started.
  void ask_again() override;
  bool waits() const override {
    return !goals_.empty() || behind() || asked_for_view_ >= next_.view;
  }
  bool behind() const override { return next_.view <= reached(); }
  void on_missing(const request_t& request) override;

 private:
  /// @throws RejectedMessage for a goal that cannot have been given yet
  void receive(const goal_t& goal);
  void move_to(const goal_t& goal);
  void publish_moved();

  Bus& bus_;
  Scene scene_;
  Base base_;
  std::map<MessageKey, goal_t> goals_;  ///< still to be carried out
  MessageKey next_{.view = 1, .attempt = 1};
  MessageKey asked_for_;
  int asked_for_view_ = 0;  ///< the latest view whose arrival somebody waits for
  RealTime real_time_;
  std::optional<std::pair<arrival_t, timing_t>> moved_;  ///< not said yet: the motion is under way
};

}  // namespace nextview
