// Runs whose log can be written no more.

#include <gtest/gtest.h>
#include <signal.h>

#include <nlohmann/json.hpp>

#include "tests/system/program.h"

namespace nextview {
namespace {

/// A run of views enough to fill what there is, started by a shell command that ends in "$@".
Outcome run_by(const std::string& command, const std::filesystem::path& folder) {
  std::vector<std::string> arguments = {"/usr/bin/env", "sh", "-c", command, "sh"};
  for (const std::string& argument : run_arguments(
           folder, 100000, {"--strategy", "paper", "--stop-window", "100000", "--no-coverage"})) {
    arguments.push_back(argument);
  }
  return run_program(arguments);
}

void expect_usable(const std::filesystem::path& log) {
  const Outcome replay = replay_folder(log);
  EXPECT_EQ(replay.status, 3) << replay.output;
  EXPECT_NE(replay.output.find("the log lacks NEXTVIEW_STOP"), std::string::npos) << replay.output;
  EXPECT_EQ(replay.output.find("no whole message"), std::string::npos) << replay.output;
  EXPECT_EQ(replay.output.find("\n0 views replayed"), std::string::npos) << replay.output;
}

TEST(FullDisk, EndsARunWithALineThatSaysSo) {
  const TemporaryFolder folder;
  const std::string mount = "mount -t tmpfs -o size=400k nextview " + folder.path().string();
  if (run_program({"/usr/bin/env", "unshare", "--mount", "sh", "-c", mount}).status != 0) {
    GTEST_SKIP() << "a small file system cannot be mounted here";
  }
  const TemporaryFolder kept;  // outlives the file system
  const Outcome outcome =
      run_by("exec unshare --mount sh -c '" + mount + " && \"$@\"; status=$?; cp " +
                 (folder / "run" / "run.lcmlog").string() + " " + kept.path().string() +
                 "; exit $status' sh \"$@\"",
             folder / "run");
  EXPECT_EQ(outcome.status, 6) << outcome.output;
  EXPECT_NE(
      outcome.output.find("run.lcmlog: No space left on device. Mend that, and go on with the "
                          "run by --resume "),
      std::string::npos)
      << outcome.output;
  expect_usable(kept / "run.lcmlog");
}

TEST(FullDisk, IsAlsoALogThatMayGrowNoMore) {
  const TemporaryFolder folder;
  const Outcome outcome = run_by("ulimit -f 600; exec \"$@\"", folder / "run");  // 300 kB
  EXPECT_EQ(outcome.status, 6) << outcome.output;
  EXPECT_NE(outcome.output.find("run.lcmlog: File too large"), std::string::npos) << outcome.output;
  expect_usable(folder / "run");
  EXPECT_EQ(summary_of(folder / "run").at("stop_reason"), "process_died");

  // With room again it goes on, here to an end that is not far off.
  Program resumed(
      {program_path("nextview_run"), "--resume", (folder / "run").string(), "--no-coverage"});
  EXPECT_TRUE(resumed.wait_for("goes on after view ")) << resumed.output();
  resumed.signal(SIGTERM);
  EXPECT_EQ(resumed.wait(), 143) << resumed.output();
}

TEST(FullDisk, OfAFolderThatCannotBeMadeIsSaid) {
  const Outcome outcome = run_views("/proc/nextview", 2);
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  EXPECT_NE(outcome.output.find("--out: /proc/nextview cannot be written to"), std::string::npos)
      << outcome.output;
}

}  // namespace
}  // namespace nextview
