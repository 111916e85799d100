#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/system/program.h"

namespace nextview {
namespace {

std::string with_frontiers() { return "--planner=" + program_path("frontier_planner"); }

// The example of docs/own-planner.md, in either room.
TEST(OwnPlanner, ThatGoesToFrontiersRecoversTheRooms) {
  const TemporaryFolder folder;
  for (const char* room : {"boxes", "columns"}) {
    const auto out = folder / room;
    const Outcome outcome = run_views(out, 300, {room, with_frontiers()});
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    const auto summary = summary_of(out);
    EXPECT_EQ(summary.at("stop_reason"), "nothing_left");
    EXPECT_GT(summary.at("surface_coverage"), 0.95);
    EXPECT_EQ(summary.at("collisions"), 0);
    EXPECT_LT(summary.at("views"), 300);
    const Outcome replay = replay_folder(out);
    EXPECT_EQ(replay.status, 0) << replay.output;
  }
}

TEST(OwnPlanner, DecidesTheSameAgain) {
  const TemporaryFolder folder;
  std::vector<std::string> digests;
  for (const char* name : {"first", "second"}) {
    ASSERT_EQ(run_views(folder / name, 12, {with_frontiers(), "--no-coverage"}).status, 0);
    const auto these = column_of_views(folder / name, "map_digest");
    ASSERT_EQ(these.size(), 12U);
    EXPECT_TRUE(digests.empty() || these == digests);
    digests = these;
  }
  ASSERT_EQ(run_views(folder / "other", 12, {with_frontiers(), "--no-coverage", "--seed=2"}).status,
            0);
  EXPECT_NE(column_of_views(folder / "other", "map_digest"), digests);
}

// It is an example as long as it is short.
TEST(OwnPlanner, IsUnder150Lines) {
  std::ifstream source(NEXTVIEW_SOURCE_DIR "/examples/frontier_planner/frontier_planner.cpp");
  int lines = 0;
  for (std::string line; std::getline(source, line);) ++lines;
  EXPECT_GT(lines, 50);
  EXPECT_LT(lines, 150);
}

}  // namespace
}  // namespace nextview
