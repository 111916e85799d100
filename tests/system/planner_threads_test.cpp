#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/system/program.h"

namespace nextview {
namespace {

/// What GCC's OpenMP says of its settings when the planner starts in an environment; of the last
/// start, should the planner start itself anew.
std::string openmp_settings(const std::vector<std::string>& environment) {
  std::vector<std::string> arguments = {"/usr/bin/env", "-u", "GOMP_SPINCOUNT",
                                        "OMP_DISPLAY_ENV=verbose"};
  arguments.insert(arguments.end(), environment.begin(), environment.end());
  arguments.push_back(program_path("nextview_planner"));
  arguments.push_back("--help");
  const Outcome outcome = run_program(arguments);
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  const std::size_t last = outcome.output.rfind("DISPLAY ENVIRONMENT BEGIN");
  return last == std::string::npos ? outcome.output : outcome.output.substr(last);
}

TEST(PlannerThreads, FallAsleepSoonUnlessToldOtherwise) {
  const std::string left_alone = openmp_settings({});
  if (left_alone.find("GOMP_") == std::string::npos) GTEST_SKIP() << "another OpenMP than GCC's";
  EXPECT_NE(left_alone.find("GOMP_SPINCOUNT = '30000'"), std::string::npos) << left_alone;
  const std::string told = openmp_settings({"GOMP_SPINCOUNT=12345"});
  EXPECT_NE(told.find("GOMP_SPINCOUNT = '12345'"), std::string::npos) << told;
}

}  // namespace
}  // namespace nextview
