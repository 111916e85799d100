#include "sensor_sim/sensor_sim_process.h"

#include <cmath>
#include <utility>

#include "scene/scene_config.h"
#include "sensor/range_image_message.h"
#include "sensor/sensor_config.h"
#include "sensor_sim/scan.h"

namespace nextview {

SensorSimProcess::SensorSimProcess(Bus& bus, const run_config_t& config)
    : bus_(bus),
      config_(config),
      scene_(load_scene(config)),
      rays_(make_ray_table(sensor_of(config))) {
  bus_.on<arrival_t>([this](const arrival_t& arrival) {
    if (arrival.arrived != 0) to_scan_.push_back(arrival);
  });
}

bool SensorSimProcess::step() {
  if (to_scan_.empty()) return false;
  const arrival_t arrival = to_scan_.front();
  to_scan_.pop_front();

  const SensorPose pose{Eigen::Vector3d(arrival.arrival_position_m), arrival.pan_rad,
                        arrival.tilt_rad};
  const auto start = std::chrono::steady_clock::now();
  RandomStream noise(config_.seed, arrival.view, arrival.attempt, RandomPurpose::RangeNoise);
  const RangeImage image =
      scan(scene_, rays_, range_limits_of(config_), pose, config_.range_noise_m, noise);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;

  const std::int64_t utime = arrival.utime + std::llround(config_.scan_duration_s * 1e6);
  for (range_image_t& message :
       range_image_messages(image, arrival.view, arrival.attempt, utime, wall.count())) {
    bus_.publish(std::move(message));
  }
  return true;
}

void SensorSimProcess::on_missing(const request_t& request) {
  if (request.wanted_channel == Channel<range_image_t>::name) {
    bus_.request<arrival_t>(request.view, request.attempt);
  }
}

}  // namespace nextview
