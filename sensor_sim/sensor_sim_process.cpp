#include "sensor_sim/sensor_sim_process.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lcmtypes/message_bounds.h"
#include "lcmtypes/parameter_bounds.h"
#include "lcmtypes/timing_message.h"
#include "scene/scene_config.h"
#include "sensor/range_image_message.h"
#include "sensor/sensor_config.h"
#include "sensor_sim/scan.h"

namespace nextview {
namespace {

/// Range images are large. Those of the last few views are what is asked for again in a run; an
/// older one is scanned anew, as its noise depends on seed, view and attempt alone.
constexpr int kViewsRemembered = 8;

}  // namespace

SensorSimProcess::SensorSimProcess(Bus& bus, const run_config_t& config,
                                   const std::function<bool()>& interrupted, double real_time,
                                   std::size_t part_bytes)
    : bus_(bus),
      config_(config),
      scene_(load_scene(config, interrupted)),
      rays_(make_ray_table(sensor_of(config))),
      part_bytes_(part_bytes),
      baseline_m_(baseline_m_of(sensor_of(config))),
      real_time_(real_time),
      course_(config, Channel<arrival_t>::name) {
  bus_.on<goal_t>([this](const goal_t& goal) { course().add(goal); });
  bus_.on<arrival_t>([this](const arrival_t& arrival) {
    course().add(arrival);
    if (asked_for_ && arrival.view >= asked_for_->view) asked_for_.reset();
    if (arrival.arrived == 0) return;
    arrivals_.emplace(key_of(arrival), arrival);
    to_scan_.push_back(key_of(arrival));
  });
}

RunCourse& SensorSimProcess::course() {
  course_.at_view(std::max(latest_view_, reached()) + 1);
  return course_;
}

bool SensorSimProcess::step() {
  if (scanned_) {
    if (!real_time_.is_over()) return false;
    publish_scanned();
    return true;
  }
  if (to_scan_.empty()) return false;
  const arrival_t& arrival = arrivals_.at(to_scan_.front());
  to_scan_.pop_front();
  scanned_ = scan_at(arrival);
  const bool again = arrival.view <= latest_view_;
  latest_view_ = std::max(latest_view_, arrival.view);
  real_time_.begin(again ? 0.0 : config_.sensor.scan_duration_s);
  if (real_time_.is_over()) publish_scanned();
  return true;
}

SensorSimProcess::Scanned SensorSimProcess::scan_at(const arrival_t& arrival) const {
  const SensorPose pose{Eigen::Vector3d(arrival.true_position_m), arrival.true_pan_rad,
                        arrival.true_tilt_rad};
  const auto start = std::chrono::steady_clock::now();
  RandomStream noise(config_.seed, arrival.view, arrival.attempt, RandomPurpose::RangeNoise);
  RangeImage image = scan(scene_, rays_, range_limits_of(config_), pose,
                          config_.sensor.range_noise_m, noise, baseline_m_);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;

  // What is seen is seen from where the sensor is, and placed where it takes itself to be.
  image.pose = {Eigen::Vector3d(arrival.believed_position_m), arrival.believed_pan_rad,
                arrival.believed_tilt_rad};
  image.position_m = image.pose.position_m;
  image.world_from_sensor = world_from_sensor_rotation(image.pose.pan_rad, image.pose.tilt_rad);

  const std::int64_t utime =
      std::min<std::int64_t>(arrival.utime + std::llround(config_.sensor.scan_duration_s * 1e6),
                             static_cast<std::int64_t>(bounds::kTime.most));
  return {
      range_image_messages(image, arrival.view, arrival.attempt, utime, part_bytes_),
      timing_message(bus_.role(), utime, arrival.view, arrival.attempt, {{"scan", wall.count()}})};
}

void SensorSimProcess::publish_scanned() {
  for (range_image_t& part : scanned_->parts) bus_.publish(std::move(part));
  bus_.publish(scanned_->timing);
  scanned_.reset();
  bus_.forget_before<range_image_t>(latest_view_ - kViewsRemembered);
  const int settled = bus_.settled_views();
  arrivals_.erase(arrivals_.begin(), arrivals_.lower_bound({settled + 1, 0, 0}));
  std::erase_if(to_scan_, [settled](const MessageKey& key) { return key.view <= settled; });
  bus_.ignore_before<goal_t>(settled + 1);
  bus_.ignore_before<arrival_t>(settled + 1);
  course_.forget_before(settled + 1);
}

std::chrono::milliseconds SensorSimProcess::longest_wait() const {
  return scanned_ ? real_time_.left() : BusProcess::longest_wait();
}

void SensorSimProcess::ask_again() {
  if (behind()) bus_.request<arrival_t>(reached(), 0);
  if (asked_for_) bus_.request<arrival_t>(asked_for_->view, asked_for_->attempt);
}

void SensorSimProcess::on_missing(const request_t& request) {
  if (request.wanted_channel != Channel<range_image_t>::name) return;
  if (scanned_ && scanned_->parts.front().view == request.view) return;  // it is on its way
  bool forgotten = false;
  for (const auto& [key, arrival] : arrivals_) {
    if (key.view != request.view || (request.attempt != 0 && key.attempt != request.attempt)) {
      continue;
    }
    forgotten = true;
    if (std::find(to_scan_.begin(), to_scan_.end(), key) == to_scan_.end()) to_scan_.push_back(key);
  }
  if (forgotten) return;
  asked_for_ = key_of(request);
  bus_.request<arrival_t>(request.view, request.attempt);
}

}  // namespace nextview
