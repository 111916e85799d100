#include "lcmtypes/wanted_messages.h"

#include <gtest/gtest.h>

#include <thread>

namespace nextview {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kAnswer{2};
const WantedMessages::Wanted kGoals{"NEXTVIEW_GOAL", 3, 0};
constexpr MessageKey kArrival{3, 1, 0};
constexpr MessageKey kOther{3, 2, 0};

TEST(WantedMessages, AreAskedForOnceAtFirst) {
  WantedMessages wanted;
  EXPECT_TRUE(wanted.want(kGoals, kArrival, kAnswer));
  EXPECT_FALSE(wanted.want(kGoals, kOther, kAnswer)) << "it is being asked for";
  EXPECT_TRUE(wanted.want(kGoals, kArrival, kAnswer)) << "it has come again";
  EXPECT_TRUE(wanted.want({"NEXTVIEW_GOAL", 4, 0}, kArrival, kAnswer));
}

TEST(WantedMessages, AreAskedForAgainUntilTheyCome) {
  WantedMessages wanted;
  wanted.want(kGoals, kArrival, kAnswer);
  for (int time = 0; time < 3; ++time) {
    std::this_thread::sleep_for(2 * kAnswer);
    EXPECT_EQ(wanted.take_due(), std::vector{kGoals});
  }
  wanted.came("NEXTVIEW_ARRIVAL", {3, 1, 0});
  wanted.came("NEXTVIEW_GOAL", {2, 1, 0});
  EXPECT_FALSE(wanted.empty()) << "another came";
  wanted.came("NEXTVIEW_GOAL", {3, 1, 0});
  EXPECT_TRUE(wanted.empty());
  EXPECT_TRUE(wanted.want(kGoals, kArrival, kAnswer)) << "the next attempt's, say";
}

TEST(WantedMessages, OfOneAttemptComeWithThatAttempt) {
  WantedMessages wanted;
  wanted.want({"NEXTVIEW_ARRIVAL", 3, 2}, kOther, kAnswer);
  wanted.came("NEXTVIEW_ARRIVAL", {3, 1, 0});
  EXPECT_FALSE(wanted.empty());
  wanted.came("NEXTVIEW_ARRIVAL", {3, 2, 0});
  EXPECT_TRUE(wanted.empty());
}

TEST(WantedMessages, AreNoMoreThanThereIsRoomFor) {
  WantedMessages wanted;
  constexpr int kMany = 3 * static_cast<int>(WantedMessages::kMost);
  for (int view = 1; view <= kMany; ++view) {
    EXPECT_TRUE(wanted.want({"NEXTVIEW_GOAL", view, 0}, kArrival, kAnswer)) << "once at least";
  }
  std::this_thread::sleep_for(2 * kAnswer);
  EXPECT_EQ(wanted.take_due().size(), WantedMessages::kMost);
}

}  // namespace
}  // namespace nextview
