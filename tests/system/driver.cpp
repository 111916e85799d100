// A driver of one's own, as README describes it: in the place of sensor_sim and base_sim, for a
// room that nobody else knows. driver LCM_URL RUN CAD_FILE

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

class Driver {
 public:
  Driver(Bus& bus, const run_config_t& config, const std::string& room)
      : bus_(bus),
        config_(config),
        room_(load_mesh(room)),
        base_(base_limits_of(config), start_pose_of(config), room_),
        rays_(make_ray_table(sensor_of(config))) {
    bus_.on<goal_t>([this](const goal_t& goal) { goals_.push_back(goal); });
    // Whoever asks for what cannot be made yet has made the goal, or knows who has.
    bus_.on_missing([this](const request_t& request) {
      if (request.wanted_channel == Channel<arrival_t>::name ||
          request.wanted_channel == Channel<range_image_t>::name) {
        bus_.request<goal_t>(request.view, request.attempt);
      }
    });
    bus_.request<goal_t>(1, 0);  // published before this program started
  }

  [[noreturn]] void run() {
    for (;;) {
      bus_.handle(std::chrono::milliseconds(100));
      for (; !goals_.empty(); goals_.pop_front()) drive_and_scan(goals_.front());
    }
  }

 private:
  void drive_and_scan(const goal_t& goal) {
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
    arrival.path_length_m = motion.path_length_m;
    for (int axis = 0; axis < 3; ++axis) {
      arrival.true_position_m[axis] = motion.pose.position_m[axis];
      arrival.believed_position_m[axis] = motion.pose.position_m[axis];
    }
    arrival.true_pan_rad = arrival.believed_pan_rad = motion.pose.pan_rad;
    arrival.true_tilt_rad = arrival.believed_tilt_rad = motion.pose.tilt_rad;
    bus_.publish(arrival);
    if (!motion.arrived) return;

    RandomStream no_noise(1, goal.view, goal.attempt, RandomPurpose::RangeNoise);
    const RangeImage image =
        scan(room_, rays_, range_limits_of(config_), motion.pose, 0.0, no_noise);
    for (range_image_t& part : range_image_messages(image, goal.view, goal.attempt, goal.utime)) {
      bus_.publish(std::move(part));
    }
  }

  Bus& bus_;
  run_config_t config_;
  Scene room_;
  Base base_;
  RayTable rays_;
  std::deque<goal_t> goals_;
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
  if (argc != 4) return 2;
  try {
    nextview::Bus bus(argv[1], std::stoll(argv[2]), "driver");
    const nextview::run_config_t config = nextview::configuration_of(bus);
    nextview::Driver(bus, config, argv[3]).run();
  } catch (const std::exception& error) {
    std::cerr << "driver: " << error.what() << std::endl;
    return 1;
  }
}
