
#include <gtest/gtest.h>

#include <set>

#include "tests/lcmtypes/bus_pair.h"
#include "tests/lcmtypes/examples.h"

namespace nextview {
namespace {

using std::chrono::milliseconds;

TEST_F(BusPair, DeliversWhatIsPublishedOnceWithItsRun) {
  std::vector<goal_t> received;
  mapper_.on<goal_t>([&](const goal_t& goal) { received.push_back(goal); });
  goal_t goal = example<goal_t>();
  goal.run = 99;
  planner_.publish(goal);
  settle();
  ASSERT_EQ(received.size(), 1U);
  EXPECT_EQ(received[0].run, 7);
  EXPECT_EQ(received[0].waypoint_m, goal.waypoint_m);
  EXPECT_EQ(mapper_.counters().delivered, 1);
}

TEST_F(BusPair, AnswersRequestsWithTheSameBytesAsOftenAsAsked) {
  int received = 0;
  mapper_.on<goal_t>([&](const goal_t&) { ++received; });
  planner_.publish(example<goal_t>());
  for (int i = 0; i < 3; ++i) mapper_.request<goal_t>(2, 1);
  settle();
  const auto goals = on_channel("NEXTVIEW_GOAL");
  ASSERT_EQ(goals.size(), 4U);
  for (const auto& bytes : goals) EXPECT_EQ(bytes, goals[0]);
  EXPECT_EQ(received, 1);
  EXPECT_EQ(mapper_.counters().repeated, 3);
  EXPECT_EQ(planner_.counters().lost, 3);
}

TEST_F(BusPair, AnswersWithAllAttemptsAndAllPartsWhenAskedForAnyAttempt) {
  goal_t goal = example<goal_t>();
  for (int view = 1; view <= 3; ++view) {
    for (int attempt = 1; attempt <= 2; ++attempt) {
      goal.view = view;
      goal.attempt = attempt;
      planner_.publish(goal);
    }
  }
  mapper_.request<goal_t>(2, 0);
  settle();
  EXPECT_EQ(planner_.counters().lost, 2);
  mapper_.request<goal_t>(2, 2);
  settle();
  EXPECT_EQ(planner_.counters().lost, 3);
  mapper_.request<goal_t>(2, 3);
  mapper_.request<goal_t>(4, 0);
  settle();
  EXPECT_EQ(planner_.counters().lost, 3);
}

TEST_F(BusPair, HandsARequestNothingAnswersToTheProcess) {
  std::vector<request_t> missing;
  planner_.on_missing([&](const request_t& request) { missing.push_back(request); });
  mapper_.on_missing([](const request_t&) { FAIL() << "its own request"; });
  mapper_.request<goal_t>(5, 0);
  settle();
  ASSERT_EQ(missing.size(), 1U);
  EXPECT_EQ(missing[0].wanted_channel, "NEXTVIEW_GOAL");
  EXPECT_EQ(missing[0].view, 5);
  EXPECT_EQ(missing[0].asker, "mapper");
}

TEST_F(BusPair, StatusMessagesAreAlwaysFresh) {
  int received = 0;
  mapper_.on<status_t>([&](const status_t&) { ++received; });
  int asked = 0;
  planner_.on_missing([&](const request_t&) { ++asked; });
  planner_.publish(example<status_t>());
  planner_.publish(example<status_t>());
  mapper_.request<status_t>(0, 0);
  settle();
  EXPECT_EQ(received, 2);
  EXPECT_EQ(asked, 1);
  EXPECT_EQ(mapper_.counters().repeated, 0);
}

TEST_F(BusPair, IgnoresAndCountsOtherRuns) {
  Bus stranger(network_.connect(), 8, "planner");
  int received = 0;
  mapper_.on<goal_t>([&](const goal_t&) { ++received; });
  stranger.publish(example<goal_t>());
  stranger.request<goal_t>(2, 1);
  settle();
  EXPECT_EQ(received, 0);
  EXPECT_EQ(mapper_.counters().foreign, 2);
  EXPECT_EQ(mapper_.counters().refused, 0);
}

TEST_F(BusPair, DropsWhatCannotBeRightWithALineAndTakesTheRightOneAfterwards) {
  int received = 0;
  mapper_.on<goal_t>([&](const goal_t&) { ++received; });
  const auto raw = network_.connect();
  goal_t wrong = example<goal_t>();
  wrong.position_m[0] = std::numeric_limits<double>::quiet_NaN();
  testing::internal::CaptureStderr();
  raw->publish("NEXTVIEW_GOAL", encode(wrong));
  raw->publish("NEXTVIEW_GOAL", std::vector<std::uint8_t>(100, 0xff));
  raw->publish("NEXTVIEW_REQUEST", {});
  settle();
  const std::string lines = testing::internal::GetCapturedStderr();
  EXPECT_NE(lines.find("mapper: dropped a message on NEXTVIEW_GOAL: position_m"), std::string::npos)
      << lines;
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 4) << lines;  // the request twice
  EXPECT_EQ(mapper_.counters().refused, 3);
  EXPECT_EQ(planner_.counters().refused, 1);
  EXPECT_EQ(received, 0);
  planner_.publish(example<goal_t>());
  settle();
  EXPECT_EQ(received, 1);
}

TEST_F(BusPair, AHandlerMayRejectAMessageAndIsGivenItAgain) {
  int calls = 0;
  mapper_.on<goal_t>([&](const goal_t&) {
    if (++calls == 1) throw RejectedMessage("view 2 of a run of 1");
  });
  testing::internal::CaptureStderr();
  planner_.publish(example<goal_t>());
  mapper_.request<goal_t>(2, 1);
  settle();
  EXPECT_NE(testing::internal::GetCapturedStderr().find("NEXTVIEW_GOAL: view 2 of a run of 1"),
            std::string::npos);
  EXPECT_EQ(calls, 2);
  EXPECT_EQ(mapper_.counters().refused, 1);
  EXPECT_EQ(mapper_.counters().delivered, 1);
}

TEST_F(BusPair, RefusesASecondHandlerOfAType) {
  mapper_.on<goal_t>([](const goal_t&) {});
  EXPECT_THROW(mapper_.on<goal_t>([](const goal_t&) {}), std::logic_error);
  EXPECT_THROW(mapper_.on<request_t>([](const request_t&) {}), std::logic_error);
}

TEST_F(BusPair, SaysOnceThatAMessageIsOfAnotherRunAndWhatToSet) {
  mapper_.on<goal_t>([](const goal_t&) { FAIL(); });
  const auto driver = network_.connect();
  goal_t goal = example<goal_t>();
  goal.run = 0;
  testing::internal::CaptureStderr();
  for (goal.view = 1; goal.view <= 3; ++goal.view) driver->publish("NEXTVIEW_GOAL", encode(goal));
  settle();
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "mapper: ignores messages of other runs, such as one on NEXTVIEW_GOAL whose run is 0: "
            "what belongs to this run must have run = 7\n");
  EXPECT_EQ(mapper_.counters().foreign, 3);
}

TEST_F(BusPair, WhatIsForgottenIsMissingAndMayBePublishedAgain) {
  goal_t goal = example<goal_t>();
  for (goal.view = 1; goal.view <= 300; ++goal.view) {
    planner_.publish(goal);
    planner_.forget_before<goal_t>(goal.view - 4);
  }
  EXPECT_EQ(planner_.remembered_bytes(), 5 * encode(goal).size());
  std::vector<int> missing;
  planner_.on_missing([&](const request_t& request) {
    missing.push_back(request.view);
    goal.view = request.view;
    planner_.publish(goal);
  });
  int received = 0;
  mapper_.on<goal_t>([&](const goal_t&) { ++received; });
  settle();
  mapper_.request<goal_t>(295, 0);
  mapper_.request<goal_t>(296, 0);
  settle();
  EXPECT_EQ(missing, std::vector<int>{295});
  EXPECT_EQ(planner_.counters().lost, 1);
  EXPECT_EQ(received, 300);
  EXPECT_EQ(mapper_.counters().repeated, 2) << "the one made again is the one that was";
}

class BusPairWithParts : public BusPair {
 protected:
  static constexpr int kParts = 6;

  BusPairWithParts() {
    mapper_.on<range_image_t>([this](const range_image_t& part) { parts_.push_back(part.part); });
    // Part 0 has the ray table and a pixel, each other one a pixel.
    const range_image_t image = example<range_image_t>();
    for (int number = 0; number < kParts; ++number) {
      range_image_t part = image;
      part.part = number;
      part.parts = kParts;
      part.first_pixel = number;
      part.pixels = 1;
      part.range_m = {image.range_m[static_cast<std::size_t>(number)]};
      if (number > 0) {
        part.first_entry = image.entries;
        part.entries = 0;
        part.entry_sin.clear();
        part.entry_cos.clear();
      }
      planner_.publish(part);
    }
    settle();
    parts_.clear();
  }
  std::size_t sent() const { return on_channel("NEXTVIEW_RANGE_IMAGE").size(); }

  std::vector<int> parts_;
};

TEST_F(BusPairWithParts, SendsAgainThePartsThatAreAskedForAndNoOthers) {
  const std::vector<PartRange> lacking = {{1, 1}, {4, 5}};
  mapper_.request_parts<range_image_t>(2, 1, lacking);
  settle();
  EXPECT_EQ(planner_.counters().lost, 3);
  EXPECT_EQ(sent(), kParts + 3U);
  EXPECT_EQ(mapper_.counters().repeated, 3);
}

TEST_F(BusPairWithParts, IsAskedForAllWhenItNeverAnswersForParts) {
  const auto deaf = network_.connect();
  int whole = 0;
  deaf->subscribe("NEXTVIEW_REQUEST", [&](std::span<const std::uint8_t>) { ++whole; });
  Bus lonely(network_.connect(), 7, "lonely");
  const std::vector<PartRange> lacking = {{0, 3}};
  for (int i = 0; i < 16; ++i) lonely.request_parts<range_image_t>(9, 1, lacking);
  while (deaf->handle(milliseconds(0))) {
  }
  EXPECT_EQ(whole, 2);
  EXPECT_EQ(on_channel("NEXTVIEW_PARTS_REQUEST").size(), 14U);
}

TEST_F(BusPairWithParts, SendsWhatSeveralAskForAtTheSameTimeOnce) {
  planner_.answer_once_within(milliseconds(60000));
  const std::vector<PartRange> lacking = {{1, 2}};
  mapper_.request_parts<range_image_t>(2, 1, lacking);
  mapper_.request<range_image_t>(2, 1);
  settle();
  EXPECT_EQ(sent(), std::size_t{kParts}) << "it was sent just now";
}

TEST_F(BusPair, AsksForPartsInOnePacket) {
  std::vector<PartRange> lacking;
  for (int part = 0; part < 1000; part += 2) lacking.push_back({part, part});
  mapper_.request_parts<range_image_t>(2, 1, lacking);
  settle();
  constexpr std::size_t kPacket = 1400;
  ASSERT_EQ(on_channel("NEXTVIEW_PARTS_REQUEST").size(), 1U);
  EXPECT_LT(on_channel("NEXTVIEW_PARTS_REQUEST")[0].size(), kPacket);
}

TEST_F(BusPair, KeepsNoMoreThanTheLastViewsOfWhatIsRecorded) {
  goal_t goal = example<goal_t>();
  Bus run(network_.connect(), 7, "run");
  for (goal.view = 1; goal.view <= 300; ++goal.view) {
    planner_.publish(goal);
    recorded_t recorded{};
    recorded.recorded_views = goal.view;
    run.publish(recorded);
    settle();
  }
  EXPECT_EQ(planner_.settled_views(), 292);
  EXPECT_EQ(planner_.remembered_bytes(), 8 * encode(goal).size());
}

TEST_F(BusPair, KeepsWhatIsNotRecorded) {
  goal_t goal = example<goal_t>();
  for (goal.view = 1; goal.view <= 300; ++goal.view) planner_.publish(goal);
  EXPECT_EQ(planner_.settled_views(), 0);
  EXPECT_EQ(planner_.remembered_bytes(), 300 * encode(goal).size());
}

TEST_F(BusPair, RemembersNoKeysOfViewsItIsThroughWith) {
  int received = 0;
  mapper_.on<goal_t>([&](const goal_t&) { ++received; });
  goal_t goal = example<goal_t>();
  for (goal.view = 1; goal.view <= 300; ++goal.view) {
    planner_.publish(goal);
    settle();
    mapper_.ignore_before<goal_t>(goal.view);
  }
  EXPECT_EQ(mapper_.remembered_keys(), 1U);
  mapper_.request<goal_t>(5, 1);
  settle();
  EXPECT_EQ(received, 300);
  EXPECT_EQ(mapper_.counters().repeated, 1);
}

TEST_F(BusPair, WhatAHandlerThrowsComesOut) {
  mapper_.on<goal_t>([](const goal_t&) { throw std::runtime_error("a fault of our own"); });
  planner_.publish(example<goal_t>());
  EXPECT_THROW(settle(), std::runtime_error);
}

TEST_F(BusPair, RefusesToPublishWhatItWouldNotAccept) {
  goal_t wrong = example<goal_t>();
  wrong.view = 0;
  EXPECT_THROW(planner_.publish(wrong), std::logic_error);
  goal_t large = example<goal_t>();
  large.waypoints = 3000;
  large.waypoint_m.resize(3000, {0.0, 0.0, 0.0});
  EXPECT_THROW(planner_.publish(large), std::logic_error);
  planner_.publish(example<goal_t>());
  goal_t other = example<goal_t>();
  other.pan_rad = 1.0;
  EXPECT_THROW(planner_.publish(other), std::logic_error);
  EXPECT_EQ(on_channel("NEXTVIEW_GOAL").size(), 1U);
}

TEST_F(BusPair, RefusesAnotherMessageUnderAKeyThatWasTaken) {
  std::vector<double> pans;
  mapper_.on<goal_t>([&](const goal_t& goal) { pans.push_back(goal.pan_rad); });
  goal_t goal = example<goal_t>();
  planner_.publish(goal);
  settle();
  goal_t forged = goal;
  forged.run = 7;
  forged.pan_rad = 1.25;
  testing::internal::CaptureStderr();
  network_.connect()->publish("NEXTVIEW_GOAL", encode(forged));
  planner_.publish(goal);
  settle();
  const std::string lines = testing::internal::GetCapturedStderr();
  EXPECT_EQ(
      lines,
      "mapper: dropped a message on NEXTVIEW_GOAL: view 2, attempt 1, part 0 differs from the "
      "one that was taken before\n");
  EXPECT_EQ(pans, std::vector<double>{goal.pan_rad});
  EXPECT_EQ(mapper_.counters().refused, 1);
  EXPECT_EQ(mapper_.counters().repeated, 1) << "the true one again";
}

TEST_F(BusPair, RefusesWhatSomebodyElseSaysUnderAKeyOfItsOwn) {
  int received = 0;
  planner_.on<goal_t>([&](const goal_t&) { ++received; });
  planner_.publish(example<goal_t>());
  goal_t forged = example<goal_t>();
  forged.run = 7;
  forged.pan_rad = 1.25;
  testing::internal::CaptureStderr();
  network_.connect()->publish("NEXTVIEW_GOAL", encode(forged));
  settle();
  EXPECT_NE(testing::internal::GetCapturedStderr().find("differs from the one published here"),
            std::string::npos);
  EXPECT_EQ(received, 1);
  EXPECT_EQ(planner_.counters().refused, 1);
}

TEST_F(LossyBusPair, LosesNothingForWhoeverAsksAgain) {
  constexpr int kGoals = 200;
  std::vector<bool> received(kGoals + 1);
  mapper_.on<goal_t>([&](const goal_t& goal) {
    EXPECT_FALSE(received[static_cast<std::size_t>(goal.view)]) << "twice";
    received[static_cast<std::size_t>(goal.view)] = true;
  });
  goal_t goal = example<goal_t>();
  for (int view = 1; view <= kGoals; ++view) {
    goal.view = view;
    planner_.publish(goal);
  }
  settle();
  const std::int64_t at_first = mapper_.counters().delivered;
  EXPECT_LT(at_first, kGoals);
  for (int view = 1; view <= kGoals; ++view) {
    for (int asked = 0; !received[static_cast<std::size_t>(view)]; ++asked) {
      ASSERT_LT(asked, 100);
      mapper_.request<goal_t>(view, 0);
      settle();
    }
  }
  EXPECT_EQ(mapper_.counters().delivered, kGoals);
  EXPECT_GT(mapper_.counters().repeated, 0);
  EXPECT_GT(network_.lost(), kGoals / 2);
}

}  // namespace
}  // namespace nextview
