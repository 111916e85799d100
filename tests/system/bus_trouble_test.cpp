#include <gtest/gtest.h>

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

/// A run in a network namespace of its own, after a shell command there.
Outcome run_in_namespace(const TemporaryFolder& folder, const std::string& command) {
  std::vector<std::string> arguments = {"/usr/bin/env",           "unshare", "--net", "sh", "-c",
                                        command + " exec \"$@\"", "sh"};
  for (const std::string& argument : run_arguments(folder / "run", 2)) {
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
  const Outcome outcome = run_in_namespace(folder, "");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.output.find("ip link set lo up"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("ip route add 224.0.0.0/4 dev lo"), std::string::npos)
      << outcome.output;
}

TEST(BusTrouble, WithWhatItSaysTyped) {
  if (!namespaces_permitted()) GTEST_SKIP() << "network namespaces are not permitted here";
  const TemporaryFolder folder;
  const Outcome outcome =
      run_in_namespace(folder, "ip link set lo up && ip route add 224.0.0.0/4 dev lo &&");
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

}  // namespace
}  // namespace nextview
