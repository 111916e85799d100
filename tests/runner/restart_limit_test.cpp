#include "runner/restart_limit.h"

#include <gtest/gtest.h>

namespace nextview {
namespace {

TEST(RestartLimit, AllowsAFewTriesWhileNothingGetsOn) {
  RestartLimit limit;
  EXPECT_TRUE(limit.allows("mapper", 0));
  EXPECT_TRUE(limit.allows("mapper", 0));
  EXPECT_TRUE(limit.allows("mapper", 0));
  EXPECT_FALSE(limit.allows("mapper", 0));
  EXPECT_FALSE(limit.allows("mapper", 0));
}

TEST(RestartLimit, BeginsAnewWhenTheRunHasGotOn) {
  RestartLimit limit;
  for (int progress = 0; progress < 20; ++progress) {
    for (int i = 0; i < RestartLimit::kTries; ++i) {
      EXPECT_TRUE(limit.allows("planner", progress)) << progress;
    }
  }
  EXPECT_FALSE(limit.allows("planner", 19));
  EXPECT_TRUE(limit.allows("planner", 20));
}

TEST(RestartLimit, CountsEveryProcessForItself) {
  RestartLimit limit;
  for (int i = 0; i < RestartLimit::kTries; ++i) EXPECT_TRUE(limit.allows("mapper", 5));
  EXPECT_TRUE(limit.allows("planner", 5));
  EXPECT_FALSE(limit.allows("mapper", 5));
}

}  // namespace
}  // namespace nextview
