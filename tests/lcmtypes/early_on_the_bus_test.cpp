// What comes before that which must have led to it.
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <set>
#include <vector>

#include "tests/lcmtypes/bus_pair.h"
#include "tests/lcmtypes/examples.h"

namespace nextview {
namespace {

/// Takes an arrival only after its goal.
class Expectant {
 public:
  Expectant(Bus& bus, TooEarly::Then then) {
    bus.on<goal_t>([this](const goal_t& goal) { goals_.insert(key_of(goal)); });
    bus.on<arrival_t>([this, then](const arrival_t& arrival) {
      heard_of_.insert(arrival.view);
      if (!goals_.contains(key_of(arrival))) {
        throw TooEarly("no goal asked for it", Channel<goal_t>::name, arrival.view, 0, then);
      }
      if (arrival.path_length_m > 1000.0) throw RejectedMessage("too long a way");
      arrived_.push_back(arrival.path_length_m);
    });
  }
  const std::vector<double>& arrived() const { return arrived_; }
  bool has_heard_of(int view) const { return heard_of_.contains(view); }

 private:
  std::set<MessageKey> goals_;
  std::set<int> heard_of_;  // views, in arrivals that were taken or not
  std::vector<double> arrived_;
};

class TooEarlyOnTheBus : public BusPair {
 protected:
  TooEarlyOnTheBus() {
    arrival_.view = goal_.view;
    arrival_.attempt = goal_.attempt;
  }
  arrival_t arrival_on_a_way_of(double path_length_m) {
    arrival_.path_length_m = path_length_m;
    return arrival_;
  }
  /// By somebody who knows the run's number.
  void forge(const arrival_t& arrival) {
    arrival_t forged = arrival;
    forged.run = 7;
    stranger_->publish("NEXTVIEW_ARRIVAL", encode(forged));
  }

  goal_t goal_ = example<goal_t>();
  arrival_t arrival_ = example<arrival_t>();
  std::unique_ptr<Transport> stranger_ = network_.connect();
};

TEST_F(TooEarlyOnTheBus, AMessageIsRefusedAndAskedForAnewWhenWhatLedToItHasCome) {
  const Expectant expectant(mapper_, TooEarly::Then::AskAnew);
  testing::internal::CaptureStderr();
  forge(arrival_on_a_way_of(2.0));
  planner_.publish(arrival_on_a_way_of(3.0));
  settle();
  EXPECT_TRUE(expectant.arrived().empty());
  EXPECT_EQ(mapper_.counters().refused, 2);
  EXPECT_GE(on_channel("NEXTVIEW_REQUEST").size(), 1U) << "for the goal";
  planner_.publish(goal_);
  settle();
  EXPECT_EQ(expectant.arrived(), std::vector<double>{3.0}) << "from its publisher";
  EXPECT_NE(testing::internal::GetCapturedStderr().find("no goal asked for it"), std::string::npos);
}

TEST_F(TooEarlyOnTheBus, OneThatIsKeptIsJudgedWhenWhatLedToItHasCome) {
  const Expectant expectant(mapper_, TooEarly::Then::JudgeAgain);
  testing::internal::CaptureStderr();
  forge(arrival_on_a_way_of(2000.0));
  forge(arrival_on_a_way_of(3.0));
  forge(arrival_on_a_way_of(4.0));
  settle();
  EXPECT_TRUE(expectant.arrived().empty());
  EXPECT_EQ(mapper_.counters().refused, 0);
  planner_.publish(goal_);
  settle();
  const std::string lines = testing::internal::GetCapturedStderr();
  EXPECT_EQ(expectant.arrived(), std::vector<double>{3.0});
  EXPECT_EQ(mapper_.counters().refused, 2) << lines;
  EXPECT_NE(lines.find("too long a way"), std::string::npos) << lines;
  EXPECT_NE(lines.find("differs from the one that was taken before"), std::string::npos) << lines;
}

TEST_F(TooEarlyOnTheBus, NoMoreAreKeptThanThereIsRoomFor) {
  const Expectant expectant(mapper_, TooEarly::Then::JudgeAgain);
  testing::internal::CaptureStderr();
  constexpr int kMore = 100;
  for (std::size_t i = 0; i < EarlyMessages::kMost + kMore; ++i) {
    forge(arrival_on_a_way_of(static_cast<double>(i)));
  }
  settle();
  testing::internal::GetCapturedStderr();
  EXPECT_EQ(mapper_.counters().refused, kMore);
}

class TooEarlyOnALossyBus : public LossyBusPair,
                            public testing::WithParamInterface<TooEarly::Then> {};

// Nobody else asks: neither the planner for an answer nor the mapper for goals or arrivals.
TEST_P(TooEarlyOnALossyBus, WhatLedToAMessageIsAskedForUntilItComes) {
  constexpr int kViews = 20;
  const Expectant expectant(mapper_, GetParam());
  testing::internal::CaptureStderr();
  goal_t goal = example<goal_t>();
  arrival_t arrival = example<arrival_t>();
  arrival.attempt = goal.attempt;
  for (int view = 1; view <= kViews; ++view) {
    goal.view = arrival.view = view;
    planner_.publish(goal);
    while (!expectant.has_heard_of(view)) {
      planner_.publish(arrival);
      settle();
    }
  }
  const auto deadline = std::chrono::steady_clock::now() + WantedMessages::kLongest;
  while (expectant.arrived().size() < kViews && std::chrono::steady_clock::now() < deadline) {
    settle();
  }
  testing::internal::GetCapturedStderr();
  EXPECT_EQ(expectant.arrived().size(), kViews);
}

INSTANTIATE_TEST_SUITE_P(With, TooEarlyOnALossyBus,
                         testing::Values(TooEarly::Then::AskAnew, TooEarly::Then::JudgeAgain),
                         [](const auto& then) {
                           return then.param == TooEarly::Then::AskAnew ? "AskAnew" : "JudgeAgain";
                         });

}  // namespace
}  // namespace nextview
