#pragma once

#include <deque>

#include "lcmtypes/bus_process.h"
#include "scene/scene.h"
#include "sensor/sensor_geometry.h"

namespace nextview {

/// The simulated sensor on the bus: a range image for every arrival.
class SensorSimProcess : public BusProcess {
 public:
  /// @throws SceneError when the run's scene cannot be loaded
  SensorSimProcess(Bus& bus, const run_config_t& config);

  /// Scans at the next arrival.
  bool step() override;
  void on_missing(const request_t& request) override;

 private:
  Bus& bus_;
  run_config_t config_;
  Scene scene_;
  RayTable rays_;
  std::deque<arrival_t> to_scan_;
};

}  // namespace nextview
