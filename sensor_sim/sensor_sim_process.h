#pragma once

#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "lcmtypes/bus_process.h"
#include "lcmtypes/real_time.h"
#include "lcmtypes/run_course.h"
#include "scene/scene.h"
#include "sensor/range_image_message.h"
#include "sensor/sensor_geometry.h"

namespace nextview {

/// The simulated sensor on the bus: a range image for every arrival.
class SensorSimProcess : public BusProcess {
 public:
  /// @throws SceneError when the run's scene cannot be loaded
  /// @param interrupted  when to give up loading it, as in LoadLimits
  /// @param real_time  simulated seconds a second; 0: at once
  /// @param part_bytes  of ray table and ranges a part of a range image carries
  SensorSimProcess(Bus& bus, const run_config_t& config,
                   const std::function<bool()>& interrupted = {}, double real_time = 0.0,
                   std::size_t part_bytes = kPartBytes);

  /// Scans at the next arrival, or publishes what it has scanned.
  bool step() override;
  std::chrono::milliseconds longest_wait() const override;
  /// Asks for the latest arrival when it has been started again; those before come when somebody
  /// asks for their range images.
  void ask_again() override;
  bool waits() const override { return behind() || asked_for_; }
  bool behind() const override { return arrivals_.empty() && reached() > 0; }
  /// Scans again when a range image is asked for that the bus has forgotten: the same image.
  void on_missing(const request_t& request) override;

 private:
  /// A range image in its parts, and how long it took.
  struct Scanned {
    std::vector<range_image_t> parts;
    timing_t timing;
  };
  RunCourse& course();
  Scanned scan_at(const arrival_t& arrival) const;
  void publish_scanned();

  Bus& bus_;
  run_config_t config_;
  Scene scene_;
  RayTable rays_;
  std::size_t part_bytes_;
  double baseline_m_;                         ///< of a line striper
  std::map<MessageKey, arrival_t> arrivals_;  // all that may have to be scanned at again
  std::deque<MessageKey> to_scan_;            // of arrivals_
  int latest_view_ = 0;                       // scanned
  std::optional<MessageKey> asked_for_;       // somebody waits for a scan at this arrival
  RealTime real_time_;
  RunCourse course_;
  std::optional<Scanned> scanned_;  // not published yet: the scan is under way
};

}  // namespace nextview
