#pragma once

#include <deque>
#include <functional>
#include <map>

#include "lcmtypes/bus_process.h"
#include "scene/scene.h"
#include "sensor/sensor_geometry.h"

namespace nextview {

/// The simulated sensor on the bus: a range image for every arrival.
class SensorSimProcess : public BusProcess {
 public:
  /// @throws SceneError when the run's scene cannot be loaded
  /// @param interrupted  when to give up loading it, as in LoadLimits
  SensorSimProcess(Bus& bus, const run_config_t& config,
                   const std::function<bool()>& interrupted = {});

  /// Scans at the next arrival.
  bool step() override;
  /// Asks for the latest arrival when it has been started again; those before come when somebody
  /// asks for their range images.
  void ask_again() override;
  bool behind() const override { return arrivals_.empty() && reached() > 0; }
  /// Scans again when a range image is asked for that the bus has forgotten: the same image.
  void on_missing(const request_t& request) override;

 private:
  Bus& bus_;
  run_config_t config_;
  Scene scene_;
  RayTable rays_;
  double baseline_m_;                         ///< of a line striper
  std::map<MessageKey, arrival_t> arrivals_;  // all of them
  std::deque<MessageKey> to_scan_;            // of arrivals_
  int latest_view_ = 0;                       // scanned
};

}  // namespace nextview
