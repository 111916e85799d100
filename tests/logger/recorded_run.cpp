#include "tests/logger/recorded_run.h"

#include <unistd.h>

#include <filesystem>
#include <lcm/lcm-cpp.hpp>

#include "lcmtypes/timing_message.h"
#include "mapper/mapper_process.h"
#include "planner/planner_process.h"
#include "sensor_sim/sensor_sim_process.h"
#include "tests/lcmtypes/lossy_network.h"
#include "tests/planner/boxes_run.h"

namespace nextview {
namespace {

using std::chrono::milliseconds;

run_config_t small_run() {
  run_config_t config = boxes_run_config();
  config.sensor.columns = 24;
  config.sensor.rows = 12;
  config.planner.max_views = 4;
  config.planner.max_attempts = 3;
  return config;
}

/// Goes where it is told, but once.
class RefusingBase {
 public:
  explicit RefusingBase(Bus& bus) : bus_(bus) {
    bus_.on<goal_t>([this](const goal_t& goal) { move(goal); });
  }

 private:
  void move(const goal_t& goal) {
    const bool arrived = goal.view != 3 || goal.attempt != 1;
    if (arrived) goal_ = goal;
    arrival_t arrival{};
    arrival.utime = goal.utime + (arrived ? 1000 : 0);
    arrival.view = goal.view;
    arrival.attempt = goal.attempt;
    arrival.arrived = arrived ? 1 : 0;
    if (!arrived) arrival.refusal = "a chair is in the way";
    for (int axis = 0; axis < 3; ++axis) {
      arrival.true_position_m[axis] = arrival.believed_position_m[axis] = goal_.position_m[axis];
    }
    arrival.true_pan_rad = arrival.believed_pan_rad = goal_.pan_rad;
    arrival.true_tilt_rad = arrival.believed_tilt_rad = goal_.tilt_rad;
    arrival.path_length_m = arrived ? goal.path_length_m : 0.0;
    bus_.publish(arrival);
    bus_.publish(
        timing_message(bus_.role(), arrival.utime, goal.view, goal.attempt, {{"move", 0.001}}));
  }

  Bus& bus_;
  goal_t goal_{};  // the last one reached
};

void say_ready(Bus& bus) {
  status_t status = example<status_t>();
  status.role = bus.role();
  bus.publish(status);
}

}  // namespace

Recording record_run() {
  const run_config_t config = small_run();
  LossyNetwork network({}, 1);
  Bus planner_bus(network.connect(), config.run, "planner");
  Bus base_bus(network.connect(), config.run, "base_sim");
  Bus sensor_bus(network.connect(), config.run, "sensor_sim");
  Bus mapper_bus(network.connect(), config.run, "mapper");
  Bus run_bus(network.connect(), config.run, "run");
  PlannerProcess planner(planner_bus, config);
  RefusingBase base(base_bus);
  SensorSimProcess sensor(sensor_bus, config);
  MapperProcess mapper(mapper_bus, config);
  run_bus.publish(config);
  run_bus.request<status_t>(0, 0);
  for (Bus* bus : {&base_bus, &sensor_bus, &mapper_bus}) say_ready(*bus);
  mapper_bus.publish(example<map_blocks_t>());
  pace_t pace = example<pace_t>();
  pace.last_view = config.planner.max_views + 1;  // as far as the run goes
  run_bus.publish(pace);
  mapper_bus.publish(example<parts_request_t>());
  run_bus.publish(example<recorded_t>());
  const auto turn = [&] {
    bool worked = planner.step();
    worked |= sensor.step();
    worked |= mapper.step();
    for (Bus* bus : {&planner_bus, &base_bus, &sensor_bus, &mapper_bus}) {
      worked |= bus->handle(milliseconds(0));
    }
    return worked;
  };
  while (turn()) {
  }
  return network.published();
}

Recording with_driver_for(const std::string& role, const Recording& recording) {
  const auto of_role = [&](const auto& message) { return message.role == role; };
  return without<timing_t>(without<status_t>(recording, of_role), of_role);
}

RunLog log_of(const Recording& recording) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() /
      ("nextview-recorded-run-" + std::to_string(::getpid()) + ".lcmlog");
  {
    lcm::LogFile writer(file.string(), "w");
    for (auto [channel, bytes] : recording) {
      lcm::LogEvent event{};
      event.channel = channel;
      event.data = bytes.data();
      event.datalen = static_cast<int>(bytes.size());
      writer.writeEvent(&event);
    }
  }
  RunLog log(file, std::nullopt, RangeImages::Keep);
  log.read_on();
  std::filesystem::remove(file);
  return log;
}

Recording sealed(Recording recording) {
  const RunLog log = log_of(recording);
  const stop_t& stop = log.record().stop().value();
  recording.emplace_back(Channel<seal_t>::name, encode(log.contents().seal(stop.run, stop.utime)));
  return recording;
}

}  // namespace nextview
