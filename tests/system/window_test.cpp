// Runs whose mapper has only a small window of the map open: the planner, whose map lies in one
// buffer, holds its digest against the mapper's after every view, so such a run that goes on at all
// has the same map in both.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/scene/test_worlds.h"
#include "tests/system/program.h"

namespace nextview {
namespace {

const std::vector<std::string> kSmallWindow = {"--window", "1.6", "1.6", "1.6"};

std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// A run with a window, the same without, and a replay of the first, which has one buffer.
void expect_same_run(const std::vector<std::string>& options, int views,
                     const std::vector<std::string>& window) {
  const TemporaryFolder folder;
  const std::vector<std::string> all = options + std::vector<std::string>{"--no-coverage"};
  const Outcome windowed =
      run_views(folder / "windowed", views, all + window + std::vector<std::string>{"--verbose"});
  ASSERT_EQ(windowed.status, 0) << windowed.output;
  EXPECT_NE(windowed.output.find("open, the planner all of them"), std::string::npos)
      << windowed.output;
  const Outcome whole = run_views(folder / "whole", views, all);
  ASSERT_EQ(whole.status, 0) << whole.output;
  for (const char* column : {"map_digest", "occupied_area_m2", "mean_quality", "x_m", "pan_deg"}) {
    EXPECT_EQ(column_of_views(folder / "windowed", column),
              column_of_views(folder / "whole", column))
        << column;
  }
  EXPECT_EQ(column_of_views(folder / "windowed", "map_digest").size(),
            static_cast<std::size_t>(views));
  const Outcome replay = replay_folder(folder / "windowed", {"--planner"});
  EXPECT_EQ(replay.status, 0) << replay.output;
}

TEST(Window, OfTheMapDoesNotChangeARunOfThePaper) {
  expect_same_run({"boxes", "--strategy", "paper"}, 8, kSmallWindow);
}

TEST(Window, OfTheMapDoesNotChangeARunForSurface) {
  expect_same_run({"columns", "--strategy", "surface"}, 8, kSmallWindow);
}

TEST(Window, FarSmallerThanAnOffice) {
  const auto office = kSharedScenesFolder / "cpr_office";
  if (!std::filesystem::exists(office)) {
    GTEST_SKIP() << office << " is not here: a window in a real building was NOT tested";
  }
  expect_same_run({office.string(), "--strategy", "paper"}, 4, {"--window", "6.4", "6.4", "3.2"});
}

TEST(Window, HasThreeSidesAboveZero) {
  const TemporaryFolder folder;
  const Outcome two = run_views(folder / "two", 1, {"--window", "1.6", "1.6"});
  EXPECT_GT(two.status, 100);
  EXPECT_NE(two.output.find("--window"), std::string::npos) << two.output;
  const Outcome none = run_views(folder / "none", 1, {"--window", "1.6", "0", "1.6"});
  EXPECT_GT(none.status, 100);
  EXPECT_NE(none.output.find("--window"), std::string::npos) << none.output;
}

}  // namespace
}  // namespace nextview
