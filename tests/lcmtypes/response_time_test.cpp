#include "lcmtypes/response_time.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <thread>
#include <vector>

#include "lcmtypes/ask_timer.h"

namespace nextview {
namespace {

using std::chrono::milliseconds;

TEST(ResponseTime, IsNotKnownAtFirst) {
  EXPECT_EQ(ResponseTime().timeout(), ResponseTime::kFirstTimeout);
}

TEST(ResponseTime, IsWaitedForFourTimes) {
  ResponseTime response;
  for (int i = 0; i < 100; ++i) response.took(milliseconds(10));
  EXPECT_EQ(response.timeout(), milliseconds(40));
}

TEST(ResponseTime, IsNoLongerForWhatWasLostOnTheWay) {
  ResponseTime response;
  for (int i = 0; i < 100; ++i) response.took(milliseconds(i % 2 == 0 ? 10 : 300));
  EXPECT_EQ(response.timeout(), milliseconds(40));
}

TEST(ResponseTime, FollowsWorkThatGetsLonger) {
  ResponseTime response;
  for (int i = 0; i < 100; ++i) response.took(milliseconds(10));
  for (int i = 0; i < 16; ++i) response.took(milliseconds(50));
  EXPECT_EQ(response.timeout(), milliseconds(200));
}

TEST(ResponseTime, HasBounds) {
  ResponseTime quick;
  quick.took(std::chrono::microseconds(20));
  EXPECT_EQ(quick.timeout(), ResponseTime::kShortestTimeout);
  ResponseTime slow;
  slow.took(std::chrono::minutes(3));
  EXPECT_EQ(slow.timeout(), ResponseTime::kLongestTimeout);
}

TEST(AskTimer, StaysEvenForAWhileAndThenWaitsLonger) {
  AskTimer timer(milliseconds(2), milliseconds(8));
  std::vector<milliseconds> waits;
  while (waits.size() < AskTimer::kEvenAsks + 3) {
    if (timer.due()) {
      waits.push_back(timer.left());
    } else {
      std::this_thread::sleep_for(timer.left());
    }
  }
  for (int i = 0; i + 1 < AskTimer::kEvenAsks; ++i) {
    EXPECT_LE(waits[static_cast<std::size_t>(i)], milliseconds(2));
  }
  EXPECT_GT(waits[AskTimer::kEvenAsks], milliseconds(4));
  EXPECT_LE(waits.back(), milliseconds(8));
}

}  // namespace
}  // namespace nextview
