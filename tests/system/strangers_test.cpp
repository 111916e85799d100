// Whole runs with a stranger on their bus, or where there can be none.

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
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

/// Two crafted fragments, at which liblcm writes out of bounds, and a message without a channel, at
/// which its readers of logs stop.
void send_crafted(const std::string& lcm_url) {
  const RawSender stranger(lcm_url);
  for (const auto& fragment : crafted_fragments()) stranger.send(fragment);
  stranger.send(lcm_datagram("", {1, 2, 3}));
}

TEST(FragmentsInARun, ChangeNothingThoughTheRecorderIsLiblcms) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_views(folder / "alone", kViews).status, 0);
  const PortLock port = PortLock::acquire();
  Program run(run_arguments(folder / "run", kViews, {"--lcm-url", port.lcm_url()}));
  for (const char* moment : {"view   1/", "view   4/"}) {
    ASSERT_TRUE(run.wait_for(moment)) << run.output();
    send_crafted(port.lcm_url());
  }
  EXPECT_EQ(run.wait(), 0) << run.output();
  EXPECT_EQ(column_of_views(folder / "run", "map_digest"),
            column_of_views(folder / "alone", "map_digest"));
  EXPECT_EQ(replay_folder(folder / "run").status, 0) << replay_folder(folder / "run").output;
}

TEST(FragmentsInARun, DoNotReachANetworkOfItsOwn) {
  const TemporaryFolder folder;
  Program run(run_arguments(folder / "run", 100000,
                            {"--verbose", "--strategy", "paper", "--stop-window", "100000"}));
  ASSERT_TRUE(run.wait_for("bus: ")) << run.output();
  ASSERT_TRUE(run.wait_for("view   2/")) << run.output();
  if (run.output().find("in a network of its own") == std::string::npos) {
    run.signal(SIGTERM);
    run.wait();
    GTEST_SKIP() << "this user may not make a network namespace, so nothing was tested";
  }
  const std::string output = run.output();
  const std::size_t begin = output.find("bus: ") + 5;
  send_crafted(output.substr(begin, output.find(',', begin) - begin));
  ASSERT_TRUE(run.wait_for("view  40/")) << run.output();
  run.signal(SIGTERM);
  EXPECT_EQ(run.wait(), 143) << run.output();
  EXPECT_EQ(run.output().find("lcm-logger was"), std::string::npos) << run.output();
  EXPECT_EQ(summary_of(folder / "run").at("messages").at("mapper").at("refused"), 0);
  const std::string events = replay_folder(folder / "run").output;
  EXPECT_EQ(events.find("without a channel"), std::string::npos) << events;
}

/// A key of 32 bytes, in a file for nobody else's eyes.
std::string key_file(const std::filesystem::path& file, char letter) {
  std::ofstream(file) << std::string(32, letter);
  std::filesystem::permissions(file, std::filesystem::perms::owner_read);
  return file.string();
}

TEST(KeyedRun, TakesOnlyWhatItsKeyHasSigned) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_views(folder / "alone", kViews).status, 0);
  const std::string key = key_file(folder / "key", 'k');
  const PortLock port = PortLock::acquire();
  Program run(run_arguments(folder / "keyed", kViews,
                            {"--verbose", "--lcm-url", port.lcm_url(), "--key-file", key}));
  ASSERT_TRUE(run.wait_for(", run ")) << run.output();
  // The goal that is next, before the planner says it, which without a key would be believed.
  const std::int64_t number = number_in(run.output());
  Bus forger(port.lcm_url(), number, "forger");
  Bus stranger(port.lcm_url(), number, "stranger",
               RunKey::read(key_file(folder / "other_key", 'o')));
  goal_t goal = example<goal_t>();
  arrival_t arrival = example<arrival_t>();
  for (const char* moment : {", run ", "view   2/"}) {  // nobody listens yet, all do
    ASSERT_TRUE(run.wait_for(moment)) << run.output();
    for (goal.view = 1; goal.view <= kViews; ++goal.view) {
      arrival.view = goal.view;
      for (Bus* other : {&forger, &stranger}) {
        other->publish(goal);
        other->publish(arrival);
      }
    }
  }
  EXPECT_EQ(run.wait(), 0) << run.output();
  EXPECT_NE(run.output().find("not signed by the run's key"), std::string::npos) << run.output();
  EXPECT_EQ(column_of_views(folder / "keyed", "map_digest"),
            column_of_views(folder / "alone", "map_digest"));
  for (const char* role : {"mapper", "planner", "sensor_sim", "base_sim"}) {
    EXPECT_GE(
        summary_of(folder / "keyed").at("messages").at(role).at("refused").get<std::int64_t>(), 2)
        << role;
  }

  const Outcome checked = replay_folder(folder / "keyed", {"--planner", "--key-file", key});
  EXPECT_EQ(checked.status, 0) << checked.output;
  EXPECT_NE(checked.output.find("is not signed by the run's key"), std::string::npos);
  EXPECT_EQ(checked.output.find("was not checked"), std::string::npos) << checked.output;
  const Outcome unchecked = replay_folder(folder / "keyed");
  EXPECT_NE(unchecked.output.find("messages are signed, which was not checked"), std::string::npos)
      << unchecked.output;
  const Outcome of_another =
      replay_folder(folder / "keyed", {"--key-file", (folder / "other_key").string()});
  EXPECT_EQ(of_another.status, 1);
  EXPECT_NE(of_another.output.find("is not signed by the run's key"), std::string::npos)
      << of_another.output;
}

TEST(KeyedRun, IsTakenUpAgainWithItsKeyOnly) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_views(folder / "alone", kViews).status, 0);
  const std::string key = key_file(folder / "key", 'k');
  Program run(run_arguments(folder / "run", kViews, {"--key-file", key}));
  ASSERT_TRUE(run.wait_for("view   3/")) << run.output();
  run.signal(SIGKILL);
  run.wait();
  const std::vector<std::string> resume = {program_path("nextview_run"), "--resume",
                                           (folder / "run").string()};
  const auto resumed = [&resume](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = resume;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  };
  EXPECT_NE(resumed({}).output.find("is signed: name the run's key by --key-file"),
            std::string::npos);
  EXPECT_NE(resumed({"--key-file", key_file(folder / "other_key", 'o')})
                .output.find("holds no run's configuration signed by this key"),
            std::string::npos);
  const Outcome outcome = resumed({"--key-file", key});
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_EQ(column_of_views(folder / "run", "map_digest"),
            column_of_views(folder / "alone", "map_digest"));
  EXPECT_EQ(replay_folder(folder / "run", {"--key-file", key}).status, 0);
}

TEST(PrivateRun, IsInANetworkOfItsOwnAndSaysHowToJoinIt) {
  const TemporaryFolder folder;
  Program run(
      run_arguments(folder / "run", 100000, {"--strategy", "paper", "--stop-window", "100000"}));
  ASSERT_TRUE(run.wait_for("view   2/")) << run.output();
  if (run.output().find("in a network of its own") == std::string::npos) {
    EXPECT_NE(run.output().find("there can be no network of its own here"), std::string::npos)
        << run.output();
    run.signal(SIGTERM);
    run.wait();
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

TEST(PrivateRun, IsNoneWhereOthersAreExpectedOrItIsToldSo) {
  const TemporaryFolder folder;
  const PortLock port = PortLock::acquire();
  int number = 0;
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--no-private"}, {"--lcm-url", port.lcm_url()}}) {
    const Outcome run = run_views(folder / std::to_string(++number), 2, more);
    EXPECT_EQ(run.status, 0) << run.output;
    EXPECT_EQ(run.output.find("network of its own"), std::string::npos) << run.output;
  }
}

}  // namespace
}  // namespace nextview
