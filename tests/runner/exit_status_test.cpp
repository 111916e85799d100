#include "runner/exit_status.h"

#include <gtest/gtest.h>

#include <set>

namespace nextview {
namespace {

TEST(ExitStatus, OnlyASuccessExitsWithZero) {
  std::set<int> failures;
  int successes = 0;
  for (const StopReason reason : all_stop_reasons()) {
    if (exit_status(reason) == 0) {
      ++successes;
    } else {
      failures.insert(exit_status(reason));
    }
  }
  EXPECT_EQ(successes, 5);
  EXPECT_EQ(failures.size(), 6u);
}

TEST(ExitStatus, IsTheSameByName) {
  for (const StopReason reason : all_stop_reasons()) {
    EXPECT_EQ(exit_status(to_string(reason)), exit_status(reason));
  }
}

TEST(ExitStatus, OfAReasonNobodyKnowsIsAFailure) {
  EXPECT_EQ(exit_status("bored"), 1);
  EXPECT_EQ(exit_status(""), 1);
}

}  // namespace
}  // namespace nextview
