#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/stat.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>

#include "lcmtypes/bus.h"
#include "logger/run_log.h"
#include "runner/port_lock.h"
#include "tests/system/program.h"

namespace nextview {
namespace {

TEST(BusTrouble, WithoutLcmLoggerItSaysWhatToInstall) {
  const TemporaryFolder folder;
  std::vector<std::string> arguments = {"/usr/bin/env", "PATH=" + folder.path().string()};
  for (const std::string& argument : run_arguments(folder / "run", 2)) {
    arguments.push_back(argument);
  }
  const Outcome outcome = run_program(arguments);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.output,
            "nextview_run: lcm-logger is not in PATH: type apt-get install liblcm-bin\n");
}

/// A run in a network namespace that is made for it, after a shell command there.
/// @param more "--no-private": it stays in this one
Outcome run_in_namespace(const TemporaryFolder& folder, const std::string& command,
                         const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {"/usr/bin/env",           "unshare", "--net", "sh", "-c",
                                        command + " exec \"$@\"", "sh"};
  for (const std::string& argument : run_arguments(folder / "run", 2, more)) {
    arguments.push_back(argument);
  }
  return run_program(arguments);
}

bool namespaces_permitted() {
  return run_program({"/usr/bin/env", "unshare", "--net", "true"}).status == 0;
}

TEST(BusTrouble, WithoutMulticastRouteItSaysWhatToType) {
  if (!namespaces_permitted()) GTEST_SKIP() << "network namespaces are not permitted here";
  const TemporaryFolder folder;
  const Outcome outcome = run_in_namespace(folder, "", {"--no-private"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.output.find("ip link set lo up"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("ip route add 224.0.0.0/4 dev lo"), std::string::npos)
      << outcome.output;
}

TEST(BusTrouble, WithWhatItSaysTyped) {
  if (!namespaces_permitted()) GTEST_SKIP() << "network namespaces are not permitted here";
  const TemporaryFolder folder;
  const Outcome outcome = run_in_namespace(
      folder, "ip link set lo up && ip route add 224.0.0.0/4 dev lo &&", {"--no-private"});
  EXPECT_EQ(outcome.status, 0) << outcome.output;
}

TEST(BusTrouble, ANetworkOfItsOwnHasARoute) {
  if (!namespaces_permitted()) GTEST_SKIP() << "network namespaces are not permitted here";
  const TemporaryFolder folder;
  const Outcome outcome = run_in_namespace(folder, "", {});
  EXPECT_EQ(outcome.status, 0) << outcome.output;
}

TEST(BusTrouble, WhatTheRecorderMissedIsAskedForAgain) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink(program_path("forgetful_recorder"), folder / "lcm-logger");
  std::vector<std::string> arguments = {"/usr/bin/env", "PATH=" + folder.path().string()};
  for (const std::string& argument : run_arguments(folder / "run", 8, {"--verbose"})) {
    arguments.push_back(argument);
  }
  const Outcome outcome = run_program(arguments);
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("forgot "), std::string::npos) << outcome.output;
  const Outcome replay = replay_folder(folder / "run", {"--planner"});
  EXPECT_EQ(replay.status, 0) << replay.output;
}

// The run asks for it again and again, and its requests are recorded: the log grows, and is none
// the better for it.
TEST(BusTrouble, ARecorderThatNeverWritesAMessageIsNotWaitedForForEver) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink(program_path("forgetful_recorder"), folder / "lcm-logger");
  std::vector<std::string> arguments = {"/usr/bin/env", "PATH=" + folder.path().string(),
                                        "NEXTVIEW_NEVER_RECORDED=NEXTVIEW_SEARCH"};
  for (const std::string& argument : run_arguments(folder / "run", 3, {"--patience", "3"})) {
    arguments.push_back(argument);
  }
  const Outcome outcome = run_program(arguments);
  EXPECT_EQ(outcome.status, 5) << outcome.output;
  EXPECT_NE(
      outcome.output.find("nextview_run: no_answer: the log still lacks NEXTVIEW_SEARCH of "
                          "view 2, attempt 1, however often it was asked for (the planner had "
                          "ended the run by then: view_limit)"),
      std::string::npos)
      << outcome.output;
  const auto summary = summary_of(folder / "run");
  EXPECT_EQ(summary.at("stop_reason"), "no_answer");
  EXPECT_EQ(summary.at("views"), 3);
  EXPECT_EQ(column_of_views(folder / "run", "view").size(), 3U);
  const Outcome replay = replay_folder(folder / "run");
  EXPECT_EQ(replay.status, 3) << replay.output;
  EXPECT_NE(replay.output.find("the log lacks NEXTVIEW_SEARCH of view 2, attempt 1"),
            std::string::npos)
      << replay.output;
}

/// The number of a run that was started with --verbose.
std::int64_t number_of(Program& run) {
  static constexpr std::string_view kBefore = ", run ";
  EXPECT_TRUE(run.wait_for(kBefore.data())) << run.output();
  return std::stoll(run.output().substr(run.output().find(kBefore) + kBefore.size()));
}

void expect_artefacts_of_a_failed_bus(Program& run, const TemporaryFolder& folder) {
  EXPECT_EQ(run.wait(), 7) << run.output();
  EXPECT_NE(run.output().find("bus_failed: LCM cannot publish"), std::string::npos) << run.output();
  EXPECT_GE(column_of_views(folder / "run", "view").size(), 3U);
  EXPECT_EQ(summary_of(folder / "run").at("stop_reason"), "bus_failed");
}

/// Of a run that only its bus can end.
std::vector<std::string> endless_run(const TemporaryFolder& folder) {
  return run_arguments(
      folder / "run", 100000,
      {"--strategy", "paper", "--stop-window", "100000", "--verbose", "--no-private"});
}

TEST(BusTrouble, ThatComesInMidRunLeavesTheArtefacts) {
  const TemporaryFolder folder;
  std::vector<std::string> arguments = {"/usr/bin/env",
                                        std::string("LD_PRELOAD=") + NEXTVIEW_FAILING_NETWORK,
                                        "NEXTVIEW_NETWORK_FAILS=" + (folder / "now").string()};
  for (const std::string& argument : endless_run(folder)) arguments.push_back(argument);
  Program run(arguments);
  ASSERT_TRUE(run.wait_for("view   3/")) << run.output();
  // The run itself speaks only when it has to ask.
  ::kill(run.child("sensor_sim"), SIGSTOP);
  std::ofstream(folder / "now") << "";
  expect_artefacts_of_a_failed_bus(run, folder);
  const Outcome replay = replay_folder(folder / "run");
  EXPECT_EQ(replay.status, 3) << replay.output;
  EXPECT_NE(replay.output.find("the log lacks NEXTVIEW_STOP"), std::string::npos) << replay.output;
}

TEST(BusTrouble, OfARouteThatGoesInMidRunLeavesTheArtefacts) {
  if (!namespaces_permitted()) GTEST_SKIP() << "network namespaces are not permitted here";
  const TemporaryFolder folder;
  std::vector<std::string> arguments = {
      "/usr/bin/env",
      "unshare",
      "--net",
      "sh",
      "-c",
      "ip link set lo up && ip route add 224.0.0.0/4 dev lo && exec \"$@\"",
      "sh"};
  for (const std::string& argument : endless_run(folder)) arguments.push_back(argument);
  Program run(arguments);
  const std::int64_t number = number_of(run);
  ASSERT_TRUE(run.wait_for("view   3/")) << run.output();
  // All wait for a scan that does not come, and then nobody but the run itself speaks.
  ::kill(run.child("sensor_sim"), SIGSTOP);
  RunLog log(folder / "run" / "run.lcmlog", number, RangeImages::OnlyCount);
  for (log.read_on();
       !log.record().arrival(log.record().latest_view(), 1) || log.record().missing().empty();
       log.read_on()) {
    ::poll(nullptr, 0, 5);
  }
  for (const char* role : {"base_sim", "mapper", "planner"}) ::kill(run.child(role), SIGSTOP);
  ASSERT_EQ(run_program({"/usr/bin/env", "nsenter",
                         "--net=/proc/" + std::to_string(run.pid()) + "/ns/net", "ip", "route",
                         "del", "224.0.0.0/4", "dev", "lo"})
                .status,
            0);
  expect_artefacts_of_a_failed_bus(run, folder);
}

/// Looks on at a run of three views and says how it is whenever somebody asks, as the processes do.
class Viewer {
 public:
  Viewer(const std::string& lcm_url, Program& run)
      : run_(run), bus_(lcm_url, number_of(run), "viewer") {
    bus_.on_missing([this](const request_t& request) {
      if (request.wanted_channel == Channel<status_t>::name) say_how_it_is();
    });
    bus_.on<goal_t>([this](const goal_t&) { phase_ = Phase::Views; });
    // Held up here, so that the run still collects statuses when this one comes at its end.
    bus_.on<arrival_t>([this](const arrival_t& arrival) {
      if (arrival.view == 3) ::kill(run_.child("base_sim"), SIGSTOP);
    });
    bus_.on<stop_t>([this](const stop_t&) {
      phase_ = Phase::End;
      say_how_it_is();
      ::kill(run_.child("base_sim"), SIGCONT);
    });
    bus_.request<run_config_t>(0, 0);
    say_how_it_is();
  }

  void look_on() { bus_.handle(std::chrono::milliseconds(5)); }

  enum Phase { Start, Views, End };
  /// How often it has said how it is while the run was there.
  int said(Phase phase) const { return said_[phase]; }

 private:
  void say_how_it_is() {
    ++said_[phase_];
    status_t status{};
    status.role = "viewer";
    status.program_version = "viewer 1";
    status.lost = phase_;
    bus_.publish(status);
  }

  Program& run_;
  Bus bus_;
  Phase phase_ = Phase::Start;
  std::array<int, 3> said_{};
};

TEST(ForeignMember, ThatAsksAndSaysHowItIsDoesNotDisturbARun) {
  const TemporaryFolder folder;
  // A recorder that waits until the viewer has spoken, so that the run hears it in starting up.
  const auto recorder = find_in_path("lcm-logger");
  ASSERT_TRUE(recorder);
  std::ofstream(folder / "lcm-logger") << "#!/bin/sh\nread go < " << (folder / "go").string()
                                       << "\nexec " << *recorder << " \"$@\"\n";
  std::filesystem::permissions(folder / "lcm-logger", std::filesystem::perms::owner_all);
  ASSERT_EQ(::mkfifo((folder / "go").c_str(), 0600), 0);
  const PortLock port = PortLock::acquire();
  std::vector<std::string> arguments = {"/usr/bin/env", "PATH=" + folder.path().string()};
  for (const std::string& argument :
       run_arguments(folder / "run", 3, {"--verbose", "--lcm-url", port.lcm_url()})) {
    arguments.push_back(argument);
  }
  Program run(arguments);
  Viewer viewer(port.lcm_url(), run);
  std::ofstream(folder / "go") << "go" << std::endl;
  while (run.running()) viewer.look_on();
  EXPECT_EQ(run.wait(), 0) << run.output();
  EXPECT_GT(viewer.said(Viewer::Start), 1) << "not while the run collected statuses at its start";
  const nlohmann::json messages = summary_of(folder / "run").at("messages");
  for (const char* role : {"base_sim", "sensor_sim", "mapper", "planner", "viewer"}) {
    EXPECT_TRUE(messages.contains(role)) << role;
  }
  ASSERT_TRUE(messages.contains("viewer")) << "the run has not heard it";
  EXPECT_EQ(messages.at("viewer").at("lost"), int{Viewer::End}) << "not heard at the run's end";
}

}  // namespace
}  // namespace nextview
