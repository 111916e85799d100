#include "sensor_sim/sensor_sim_process.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/lcmtypes/lossy_network.h"
#include "tests/planner/boxes_run.h"

namespace nextview {
namespace {

using std::chrono::milliseconds;

// It does not hold every range image of a run, and still answers for every one with the same bytes.
TEST(SensorSimProcess, ScansAnOldViewAgainWhenItIsAskedForIt) {
  constexpr int kViews = 40;
  run_config_t config = boxes_run_config();
  config.sensor.range_noise_m = 0.01;
  LossyNetwork network({}, 1);
  Bus sensor_bus(network.connect(), 7, "sensor_sim");
  Bus base_bus(network.connect(), 7, "base_sim");
  SensorSimProcess sensor(sensor_bus, config);
  sensor_bus.on_missing([&](const request_t& request) { sensor.on_missing(request); });
  const auto settle = [&] {
    while (sensor_bus.handle(milliseconds(0)) || base_bus.handle(milliseconds(0)) ||
           sensor.step()) {
    }
  };
  arrival_t arrival{};
  arrival.arrived = 1;
  arrival.attempt = 1;
  arrival.true_position_m[0] = arrival.believed_position_m[0] = 0.7;
  arrival.true_position_m[1] = arrival.believed_position_m[1] = 1.0;
  arrival.true_position_m[2] = arrival.believed_position_m[2] = 1.2;
  std::size_t remembered_bytes = 0;
  goal_t goal = example<goal_t>();
  goal.utime = 0;
  goal.attempt = 1;
  for (arrival.view = 1; arrival.view <= kViews; ++arrival.view) {
    goal.view = arrival.view;
    base_bus.publish(goal);
    base_bus.publish(arrival);
    settle();
    if (arrival.view == kViews / 2) remembered_bytes = sensor_bus.remembered_bytes();
  }
  EXPECT_GT(remembered_bytes, 0U);
  EXPECT_EQ(sensor_bus.remembered_bytes(), remembered_bytes) << "the same at 20 views and at 40";

  for (const int view : {1, 2, kViews}) base_bus.request<range_image_t>(view, 0);
  settle();
  std::map<int, std::vector<LossyNetwork::Bytes>> images;
  for (const auto& [channel, bytes] : network.published()) {
    if (channel != Channel<range_image_t>::name) continue;
    images[decode_checked<range_image_t>(bytes).message.value().view].push_back(bytes);
  }
  for (const int view : {1, 2, kViews}) {
    ASSERT_EQ(images[view].size(), 2U) << view;
    EXPECT_EQ(images[view][0], images[view][1]) << view;
  }
  EXPECT_EQ(images[3].size(), 1U);
}

}  // namespace
}  // namespace nextview
