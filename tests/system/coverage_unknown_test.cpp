#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/system/program.h"

namespace nextview {
namespace {

// A corridor in which a robot that keeps its clearance has a strip of 2 cm left, and none of the
// lattice's positions: scoring gives up, and the run goes on without it.
TEST(CoverageUnknown, LeavesTheRunAloneAndSaysWhy) {
  const TemporaryFolder folder;
  std::ofstream(folder / "corridor.obj")
      << "v 0.03 0 0\nv 0.93 0 0\nv 0.93 3 0\nv 0.03 3 0\n"
         "v 0.03 0 2.5\nv 0.93 0 2.5\nv 0.93 3 2.5\nv 0.03 3 2.5\n"
         "f 1 2 3 4\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nf 5 6 7 8\n";
  const Outcome outcome = run_views(folder / "run", 1,
                                    {(folder / "corridor.obj").string(), "--start", "0.48", "1.5",
                                     "1.2", "--start-pan", "90", "--clearance", "0.44"});
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  const std::string why =
      "it could not be worked out: nothing can be reached from the start at the run's clearance";
  EXPECT_NE(outcome.output.find("unknown, because " + why), std::string::npos) << outcome.output;
  const nlohmann::json summary = summary_of(folder / "run");
  EXPECT_EQ(summary.at("views"), 1);
  EXPECT_EQ(summary.at("stop_reason"), "view_limit");
  EXPECT_TRUE(summary.at("surface_coverage").is_null());
  EXPECT_EQ(summary.at("surface_coverage_unknown"), why);
}

}  // namespace
}  // namespace nextview
