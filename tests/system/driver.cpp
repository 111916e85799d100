// A driver of one's own, as README describes it: in the place of sensor_sim and base_sim, or of one
// of the two. driver LCM_URL RUN CAD_FILE PLACE [float32]. PLACE is base_sim, sensor_sim or both;
// with float32 all that it says has gone through numbers of 32 bits.

#include <chrono>
#include <deque>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "base_sim/base.h"
#include "base_sim/base_sim_process.h"
#include "lcmtypes/bus.h"
#include "scene/mesh_file.h"
#include "sensor/range_image_message.h"
#include "sensor/sensor_config.h"
#include "sensor_sim/scan.h"

namespace nextview {
namespace {

/// What it stands in for, and how.
struct Place {
  bool drives = true;
  bool scans = true;
  bool float32 = false;

  double said(double value) const {
    return float32 ? static_cast<double>(static_cast<float>(value)) : value;
  }
};

class Driver {
 public:
  Driver(Bus& bus, const run_config_t& config, const std::string& room, const Place& place)
      : bus_(bus),
        config_(config),
        place_(place),
        room_(load_mesh(room)),
        base_(base_limits_of(config), start_pose_of(config), room_),
        rays_(make_ray_table(sensor_of(config))) {
    if (place_.drives) {
      listen_and_ask<goal_t>(goals_);  // the first was published before this program started
    } else {
      listen_and_ask<arrival_t>(arrivals_);
    }
    // Whoever asks for what cannot be made yet has made what it is made of, or knows who has.
    bus_.on_missing([this](const request_t& request) {
      const bool of_ours = request.wanted_channel == Channel<arrival_t>::name ||
                           request.wanted_channel == Channel<range_image_t>::name;
      if (!of_ours) return;
      if (place_.drives) {
        bus_.request<goal_t>(request.view, request.attempt);
      } else {
        bus_.request<arrival_t>(request.view, request.attempt);
      }
    });
  }

  [[noreturn]] void run() {
    for (;;) {
      bus_.handle(std::chrono::milliseconds(100));
      for (; !goals_.empty(); goals_.pop_front()) {
        const arrival_t arrival = drive(goals_.front());
        if (place_.scans) arrivals_.push_back(arrival);
      }
      for (; !arrivals_.empty(); arrivals_.pop_front()) {
        if (arrivals_.front().arrived != 0) scan_at(arrivals_.front());
      }
    }
  }

 private:
  template <class Message>
  void listen_and_ask(std::deque<Message>& queue) {
    bus_.on<Message>([&queue](const Message& message) { queue.push_back(message); });
    bus_.request<Message>(1, 0);
  }

  arrival_t drive(const goal_t& goal) {
    std::vector<Eigen::Vector3d> waypoints_m;
    for (const auto& waypoint : goal.waypoint_m) waypoints_m.emplace_back(waypoint.data());
    const Motion motion =
        base_.move(waypoints_m, {Eigen::Vector3d(goal.position_m), goal.pan_rad, goal.tilt_rad});
    arrival_t arrival{};
    arrival.utime = goal.utime;
    arrival.view = goal.view;
    arrival.attempt = goal.attempt;
    arrival.arrived = motion.arrived;
    arrival.refusal = motion.refusal;
    arrival.path_length_m = place_.said(motion.path_length_m);
    for (int axis = 0; axis < 3; ++axis) {
      arrival.true_position_m[axis] = arrival.believed_position_m[axis] =
          place_.said(motion.pose.position_m[axis]);
    }
    arrival.true_pan_rad = arrival.believed_pan_rad = place_.said(motion.pose.pan_rad);
    arrival.true_tilt_rad = arrival.believed_tilt_rad = place_.said(motion.pose.tilt_rad);
    bus_.publish(arrival);
    return arrival;
  }

  void scan_at(const arrival_t& arrival) {
    const SensorPose pose{Eigen::Vector3d(arrival.true_position_m), arrival.true_pan_rad,
                          arrival.true_tilt_rad};
    RandomStream no_noise(1, arrival.view, arrival.attempt, RandomPurpose::RangeNoise);
    const RangeImage image = scan(room_, rays_, range_limits_of(config_), pose, 0.0, no_noise);
    for (range_image_t& part :
         range_image_messages(image, arrival.view, arrival.attempt, arrival.utime)) {
      say(part);
      bus_.publish(std::move(part));
    }
  }

  void say(range_image_t& image) const {
    for (double& value : image.entry_sin) value = place_.said(value);
    for (double& value : image.entry_cos) value = place_.said(value);
    for (double& value : image.position_m) value = place_.said(value);
    for (auto& row : image.world_from_sensor) {
      for (double& value : row) value = place_.said(value);
    }
    image.pan_rad = place_.said(image.pan_rad);
    image.tilt_rad = place_.said(image.tilt_rad);
  }

  Bus& bus_;
  run_config_t config_;
  Place place_;
  Scene room_;
  Base base_;
  RayTable rays_;
  std::deque<goal_t> goals_;
  std::deque<arrival_t> arrivals_;
};

run_config_t configuration_of(Bus& bus) {
  std::optional<run_config_t> config;
  bus.on<run_config_t>([&config](const run_config_t& message) { config = message; });
  while (!config) {
    bus.request<run_config_t>(0, 0);
    bus.handle(std::chrono::milliseconds(100));
  }
  return *config;
}

}  // namespace
}  // namespace nextview

int main(int argc, char** argv) {
  if (argc < 5 || argc > 6) return 2;
  nextview::Place place;
  place.drives = argv[4] != std::string("sensor_sim");
  place.scans = argv[4] != std::string("base_sim");
  place.float32 = argc == 6;
  try {
    nextview::Bus bus(argv[1], std::stoll(argv[2]), "driver");
    const nextview::run_config_t config = nextview::configuration_of(bus);
    nextview::Driver(bus, config, argv[3], place).run();
  } catch (const std::exception& error) {
    std::cerr << "driver: " << error.what() << std::endl;
    return 1;
  }
}
