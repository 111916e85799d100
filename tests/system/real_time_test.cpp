#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/system/program.h"

namespace nextview {
namespace {

double seconds_of(const std::vector<std::string>& more, const std::filesystem::path& folder) {
  const auto start = std::chrono::steady_clock::now();
  const Outcome outcome = run_views(folder, 6, more);
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(RealTime, IsTheSameRunThatTakesItsTime) {
  constexpr double kPace = 20.0;
  const TemporaryFolder folder;
  seconds_of({"--no-coverage"}, folder / "at-once");
  const double took_s = seconds_of({"--no-coverage", "--real-time=20"}, folder / "watched");
  for (const char* column : {"map_digest", "x_m", "pan_deg", "simulated_s"}) {
    EXPECT_EQ(column_of_views(folder / "watched", column),
              column_of_views(folder / "at-once", column))
        << column;
  }
  // It cannot have been faster than what it simulates.
  const double simulated_s = summary_of(folder / "watched").at("simulated_s");
  EXPECT_GT(simulated_s, 10.0);
  EXPECT_GE(took_s, simulated_s / kPace);
  EXPECT_EQ(replay_folder(folder / "watched", {"--planner"}).status, 0);
}

TEST(RealTime, IsNoReasonToGiveUp) {
  const TemporaryFolder folder;
  // A scan of 2 s by the clock, where 1 s without a word ends a run.
  const Outcome outcome = run_views(
      folder / "run", 2, {"--no-coverage", "--scan-duration=20", "--real-time=10", "--patience=1"});
  EXPECT_EQ(outcome.status, 0) << outcome.output;
}

TEST(RealTime, RefusesWhatIsNoPace) {
  for (const char* pace : {"--real-time=0", "--real-time=-1", "--real-time=fast"}) {
    const Outcome outcome = run_program({program_path("nextview_run"), pace});
    EXPECT_GT(outcome.status, 100) << pace << outcome.output;
    EXPECT_NE(outcome.output.find("--real-time"), std::string::npos) << outcome.output;
  }
}

}  // namespace
}  // namespace nextview
