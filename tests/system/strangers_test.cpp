// Whole runs with a stranger on their bus, or where there can be none.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "lcmtypes/bus.h"
#include "runner/port_lock.h"
#include "runner/private_network.h"
#include "tests/lcmtypes/examples.h"
#include "tests/lcmtypes/raw_datagrams.h"
#include "tests/system/program.h"

namespace nextview {
namespace {

constexpr int kViews = 12;  // of the run that is flooded

/// The number of a run that was started with --verbose.
std::int64_t number_in(const std::string& output) {
  static constexpr std::string_view kBefore = ", run ";
  return std::stoll(output.substr(output.find(kBefore) + kBefore.size()));
}

/// What a flood is made of, with the run's number.
class Flood {
 public:
  Flood(const std::string& lcm_url, std::int64_t run) : sender_(lcm_url) {
    range_image_t image = example<range_image_t>();
    image.run = run;
    image.columns = image.rows = 4096;
    image.first_entry = 8192;
    image.entries = 0;
    image.entry_sin.clear();
    image.entry_cos.clear();
    image.parts = 2000;
    image.part = 1;
    image.pixels = 12000;
    image.range_m.assign(12000, 1.0F);
    for (int i = 0; i < 150; ++i) {
      image.view = i + 1;
      image.first_pixel = 12000 * i;
      add(image);
    }
    status_t status = example<status_t>();
    goal_t goal = example<goal_t>();
    arrival_t arrival = example<arrival_t>();
    status.run = goal.run = arrival.run = run;
    for (int i = 0; i < 300; ++i) {
      status.role = "stranger" + std::to_string(i);
      // Not of the view that is next: without a key that cannot be told from the planner's own.
      goal.view = arrival.view = i < 2 ? 1 + i : kViews + i;
      add(status);
      add(goal);
      add(arrival);
    }
  }
  void pour() const {
    for (const auto& datagram : datagrams_) sender_.send(datagram);
  }

 private:
  template <class Message>
  void add(const Message& message) {
    datagrams_.push_back(lcm_datagram(std::string(Channel<Message>::name), encode(message)));
  }
  RawSender sender_;
  std::vector<std::vector<std::uint8_t>> datagrams_;
};

TEST(FloodedRun, GoesTheSameWayInLittleMemory) {
  constexpr std::int64_t kMostBytes = 100 << 20;  // the map of "boxes" has less than one of them
  const TemporaryFolder folder;
  ASSERT_EQ(run_views(folder / "alone", kViews).status, 0);
  const PortLock port = PortLock::acquire();
  Program run(
      run_arguments(folder / "flooded", kViews, {"--verbose", "--lcm-url", port.lcm_url()}));
  ASSERT_TRUE(run.wait_for(", run ")) << run.output();
  const Flood flood(port.lcm_url(), number_in(run.output()));
  ASSERT_TRUE(run.wait_for("view   2/")) << run.output();
  for (int i = 0; i < 5 && run.running(); ++i) flood.pour();
  EXPECT_EQ(run.wait(), 0) << run.output();
  EXPECT_EQ(column_of_views(folder / "flooded", "map_digest"),
            column_of_views(folder / "alone", "map_digest"));
  const nlohmann::json summary = summary_of(folder / "flooded");
  for (const auto& [role, bytes] : summary.at("peak_memory_bytes").items()) {
    EXPECT_LT(bytes.get<std::int64_t>(), kMostBytes) << role;
  }
  for (const char* role : {"mapper", "planner", "sensor_sim", "base_sim"}) {
    EXPECT_GT(summary.at("messages").at(role).at("refused").get<std::int64_t>(), 0) << role;
  }
  const std::string said = run.output();
  EXPECT_LT(std::count(said.begin(), said.end(), '\n'), 400) << "lines";
}

TEST(PrivateRun, IsInANetworkOfItsOwnAndSaysHowToJoinIt) {
  const TemporaryFolder folder;
  Program run(run_arguments(folder / "run", 100000,
                            {"--private", "--strategy", "paper", "--stop-window", "100000"}));
  if (!run.wait_for("to join it: ")) {
    EXPECT_NE(run.output().find("--private: there can be no network of its own here"),
              std::string::npos)
        << run.output();
    GTEST_SKIP() << "this user may not make a network namespace, so nothing was tested";
  }
  ASSERT_TRUE(run.wait_for("view   2/")) << run.output();
  const auto network_of = [](pid_t pid) {
    return std::filesystem::read_symlink("/proc/" + std::to_string(pid) + "/ns/net");
  };
  EXPECT_NE(network_of(run.pid()), network_of(::getpid()));
  for (const pid_t child : run.children()) EXPECT_EQ(network_of(child), network_of(run.pid()));
  const std::string join = command_to_join_network_of(run.pid());
  EXPECT_NE(run.output().find(join), std::string::npos) << run.output();
  const Outcome seen = run_program({"/usr/bin/env", "sh", "-c", join + " cat /proc/net/dev"});
  EXPECT_EQ(seen.status, 0) << seen.output;
  EXPECT_NE(seen.output.find("lo:"), std::string::npos) << seen.output;
  EXPECT_EQ(seen.output.find("eth"), std::string::npos) << "nothing leads out";
  run.signal(SIGTERM);
  EXPECT_EQ(run.wait(), 143) << run.output();
}

}  // namespace
}  // namespace nextview
