// A driver of one's own in the place of nextview's simulators: it answers every goal by the arrival
// and the range image that a robot has left in files. docs/own-sensor.md is about it.
//
//     file_driver LCM_URL RUN FOLDER
#include <chrono>
#include <cstdio>
#include <deque>
#include <stdexcept>
#include <string>

#include "lcmtypes/bus.h"
#include "lcmtypes/standard_output.h"
#include "lcmtypes/tell_version.h"
#include "recorded_files.h"
#include "sensor/range_image_message.h"

namespace {

using namespace nextview;

class FileDriver {
 public:
  FileDriver(Bus& bus, const RecordedFiles& files) : bus_(bus), files_(files) {
    bus_.on<goal_t>([this](const goal_t& goal) { goals_.push_back(goal); });
    bus_.on<stop_t>([this](const stop_t& stop) { stop_reason_ = stop.stop_reason; });
    // Whoever asks for what has not been published yet knows of a goal that was lost on its way
    // here.
    bus_.on_missing([this](const request_t& request) {
      if (request.wanted_channel == Channel<arrival_t>::name ||
          request.wanted_channel == Channel<range_image_t>::name) {
        bus_.request<goal_t>(request.view, request.attempt);
      }
    });
    bus_.request<goal_t>(1, 0);  // it may have been published before this program started
  }

  /// Until the run has ended and nobody asks for anything any more: the recorder may have missed
  /// some.
  void run() {
    constexpr std::chrono::milliseconds kQuiet(2000);
    while (bus_.handle(kQuiet) || stop_reason_.empty()) {
      for (; !goals_.empty(); goals_.pop_front()) answer(goals_.front());
    }
    std::printf("the run has ended: %s\n", stop_reason_.c_str());
  }

 private:
  // A robot would drive along goal.waypoint_m, and scan.
  void answer(const goal_t& goal) {
    std::printf("goal of view %d: (%.2f, %.2f, %.2f) m, pan %.2f, tilt %.2f rad: %s\n", goal.view,
                goal.position_m[0], goal.position_m[1], goal.position_m[2], goal.pan_rad,
                goal.tilt_rad, goal.reason.c_str());
    const RecordedArrival* recorded = files_.arrival(goal.view, goal.attempt);
    if (recorded == nullptr) {
      throw std::runtime_error("the files hold no arrival for view " + std::to_string(goal.view) +
                               ", attempt " + std::to_string(goal.attempt) +
                               ": end the run before, by ./run --views N");
    }
    bus_.publish(arrival_message(goal, *recorded));
    if (!recorded->arrived) return;
    const auto [image, utime] = files_.scan(goal.view, goal.attempt);
    for (range_image_t& part : range_image_messages(image, goal.view, goal.attempt, utime)) {
      bus_.publish(std::move(part));
    }
  }

  static arrival_t arrival_message(const goal_t& goal, const RecordedArrival& recorded) {
    arrival_t arrival{};
    arrival.utime = recorded.utime;
    arrival.view = goal.view;
    arrival.attempt = goal.attempt;
    arrival.arrived = recorded.arrived ? 1 : 0;
    for (int axis = 0; axis < 3; ++axis) {
      arrival.true_position_m[axis] = arrival.believed_position_m[axis] =
          recorded.pose.position_m[axis];
    }
    arrival.true_pan_rad = arrival.believed_pan_rad = recorded.pose.pan_rad;
    arrival.true_tilt_rad = arrival.believed_tilt_rad = recorded.pose.tilt_rad;
    arrival.path_length_m = recorded.path_length_m;
    arrival.refusal = recorded.refusal;
    return arrival;
  }

  Bus& bus_;
  const RecordedFiles& files_;
  std::deque<goal_t> goals_;
  std::string stop_reason_;
};

}  // namespace

int main(int argc, char** argv) {
  nextview::answer_for_standard_output();
  if (tell_version(argc, argv)) return 0;
  if (argc != 4) {
    std::fprintf(stderr, "usage: file_driver LCM_URL RUN FOLDER\n");
    return 2;
  }
  try {
    const RecordedFiles files(argv[3]);
    Bus bus(argv[1], std::stoll(argv[2]), "file_driver");
    FileDriver(bus, files).run();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "file_driver: %s\n", error.what());
    return 1;
  }
}
