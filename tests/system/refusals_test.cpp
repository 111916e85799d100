#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <deque>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "base_sim/base.h"
#include "lcmtypes/bus.h"
#include "logger/run_log.h"
#include "tests/system/program.h"

namespace nextview {
namespace {

// The planner of this run keeps less clearance than the body needs.
TEST(Refusals, AreCollisionsWhereTheBodyWouldTouchSomething) {
  const TemporaryFolder folder;
  const Outcome outcome = run_views(
      folder / "run", 30, {"--clearance", "0.05", "--body-radius", "0.3", "--max-attempts", "20"});
  RunLog log(folder / "run" / "run.lcmlog", std::nullopt, RangeImages::OnlyCount);
  log.read_on();
  int refused = 0;
  for (const auto& [key, arrival] : log.record().arrivals()) {
    if (arrival.arrived) continue;
    ++refused;
    EXPECT_TRUE(arrival.refusal.starts_with("collision: the body would touch a surface"))
        << arrival.refusal;
  }
  EXPECT_GT(refused, 0) << outcome.output;
  const nlohmann::json summary = summary_of(folder / "run");
  EXPECT_EQ(summary.at("collisions"), refused);
  EXPECT_EQ(summary.at("other_refusals"), 0);
}

/// A robot of the test's own, which refuses the first goals of view 2 for these reasons, one after
/// the other, and is at once wherever else it is sent.
class FussyRobot {
 public:
  FussyRobot(const std::string& lcm_url, std::int64_t run) : bus_(lcm_url, run, "fussy robot") {
    bus_.on<goal_t>([this](const goal_t& goal) { goals_.push_back(goal); });
    bus_.request<goal_t>(1, 0);  // published before it listened
  }

  void work(std::chrono::milliseconds timeout) {
    bus_.handle(timeout);
    for (; !goals_.empty(); goals_.pop_front()) answer(goals_.front());
  }

  static constexpr std::array<std::string_view, 3> kReasons = {
      "collision: the body would touch a chair", "the lift is stuck", "too dark in there"};

 private:
  void answer(const goal_t& goal) {
    arrival_t arrival{};
    arrival.utime = goal.utime;
    arrival.view = goal.view;
    arrival.attempt = goal.attempt;
    arrival.arrived = goal.view != 2 || goal.attempt > std::ssize(kReasons);
    if (arrival.arrived) {
      at_ = goal;
    } else {
      arrival.refusal = kReasons.at(static_cast<std::size_t>(goal.attempt - 1));
    }
    for (int axis = 0; axis < 3; ++axis) {
      arrival.true_position_m[axis] = arrival.believed_position_m[axis] = at_.position_m[axis];
    }
    arrival.true_pan_rad = arrival.believed_pan_rad = at_.pan_rad;
    arrival.true_tilt_rad = arrival.believed_tilt_rad = at_.tilt_rad;
    bus_.publish(arrival);
  }

  Bus bus_;
  std::deque<goal_t> goals_;
  goal_t at_{};  // the last one it went to
};

TEST(Refusals, ForAnotherReasonAreCountedApart) {
  const TemporaryFolder folder;
  Program run(run_arguments(folder / "run", 3, {"--without", "base_sim"}));
  ASSERT_TRUE(run.wait_for(", run ")) << run.output();
  std::smatch bus;
  const std::string said = run.output();
  ASSERT_TRUE(std::regex_search(said, bus, std::regex("bus: (\\S+), run (\\d+)"))) << said;
  FussyRobot robot(bus[1], std::stoll(bus[2]));
  while (run.running()) robot.work(std::chrono::milliseconds(20));
  ASSERT_EQ(run.wait(), 0) << run.output();
  const nlohmann::json summary = summary_of(folder / "run");
  EXPECT_EQ(summary.at("views"), 3);
  EXPECT_EQ(summary.at("collisions"), 1);
  EXPECT_EQ(summary.at("other_refusals"), 2);
  EXPECT_EQ(column_of_views(folder / "run", "attempt"), (std::vector<std::string>{"1", "4", "1"}));
  const Outcome replay = replay_folder(folder / "run", {"--planner"});
  EXPECT_EQ(replay.status, 0) << replay.output;
  EXPECT_NE(replay.output.find("NEXTVIEW_ARRIVAL (what a robot of one's own says is believed)"),
            std::string::npos)
      << replay.output;
}

}  // namespace
}  // namespace nextview
