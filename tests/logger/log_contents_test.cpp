#include "logger/log_contents.h"

#include <gtest/gtest.h>

#include "lcmtypes/decode.h"
#include "tests/logger/run_messages.h"

namespace nextview {
namespace {

const std::int64_t kRun = config_message().run;

LoggedMessage event_of(std::uint64_t number, const goal_t& goal) {
  return {std::string(Channel<goal_t>::name), encode(goal), number,
          1000 + static_cast<std::int64_t>(number)};
}

LogContents numbered(const std::vector<std::uint64_t>& numbers) {
  LogContents contents;
  for (const std::uint64_t number : numbers) {
    contents.add(event_of(number, goal_of(1 + static_cast<int>(number % 9), 1)));
  }
  return contents;
}

std::vector<std::string> differences_of(const std::vector<std::uint64_t>& numbers) {
  return numbered(numbers).faults(kRun).differences;
}
std::vector<std::string> missing_of(const std::vector<std::uint64_t>& numbers) {
  return numbered(numbers).faults(kRun).missing;
}

using Lines = std::vector<std::string>;

TEST(LogContents, EventsInOrderAreNoFault) {
  EXPECT_EQ(differences_of({0, 1, 2, 3}), Lines{});
  EXPECT_EQ(missing_of({0, 1, 2, 3}), Lines{});
}

TEST(LogContents, AnotherRecorderCountsAnew) {
  EXPECT_EQ(differences_of({0, 1, 2, 0, 1, 0}), Lines{});
  EXPECT_EQ(missing_of({0, 1, 2, 0, 1, 0}), Lines{});
}

TEST(LogContents, EventsAreMissingByTheirNumbers) {
  EXPECT_EQ(missing_of({0, 1, 3}), Lines{"event 2 is not in the log, by its numbers"});
  EXPECT_EQ(missing_of({2, 3, 7}), (Lines{"events 0 to 1 are not in the log, by its numbers",
                                          "events 4 to 6 are not in the log, by its numbers"}));
  EXPECT_EQ(differences_of({0, 1, 3}), Lines{});
}

TEST(LogContents, EventsAreThereTwiceOrSwappedByTheirNumbers) {
  EXPECT_EQ(differences_of({0, 1, 1, 2}),
            Lines{"event 2 of the log has the number 1 where 2 should stand"});
  EXPECT_EQ(differences_of({0, 2, 1, 3, 4}),
            Lines{"event 1 of the log has the number 2 where 1 should stand"});
  EXPECT_EQ(missing_of({0, 2, 1, 3, 4}), Lines{});
  EXPECT_EQ(differences_of({0, 1, 70000, 3}),
            Lines{"event 2 of the log has the number 70000 where 2 should stand"});
}

LogContents sealed_contents(const std::vector<goal_t>& sealed, const std::vector<goal_t>& there) {
  LogContents before;
  for (std::size_t i = 0; i < sealed.size(); ++i) before.add(event_of(i, sealed[i]));
  LogContents after;
  std::int64_t last_us = 0;
  for (std::size_t i = 0; i < there.size(); ++i) {
    const LoggedMessage event = event_of(i, there[i]);
    last_us = event.received_us;
    after.add(event);
  }
  after.add(
      {std::string(Channel<seal_t>::name), encode(before.seal(kRun, 0)), there.size(), last_us});
  return after;
}

TEST(LogContents, WhatWasSealedIsThere) {
  const std::vector<goal_t> goals = {goal_of(1, 1), goal_of(2, 1)};
  const LogFaults faults = sealed_contents(goals, goals).faults(kRun);
  EXPECT_TRUE(faults.sealed);
  EXPECT_EQ(faults.differences, Lines{});
  EXPECT_EQ(faults.missing, Lines{});
  EXPECT_EQ(faults.remarks, Lines{});
}

TEST(LogContents, AMessageOfASealedLogMayBeThereTwice) {
  const LogFaults faults =
      sealed_contents({goal_of(1, 1)}, {goal_of(1, 1), goal_of(1, 1)}).faults(kRun);
  EXPECT_EQ(faults.differences, Lines{});
  EXPECT_EQ(faults.missing, Lines{});
}

TEST(LogContents, WhatWasSealedIsMissingOrDiffers) {
  const std::vector<goal_t> goals = {goal_of(1, 1), goal_of(2, 1)};
  EXPECT_EQ(sealed_contents(goals, {goal_of(1, 1)}).faults(kRun).missing,
            Lines{"2 messages on NEXTVIEW_GOAL were sealed, 1 is there"});
  EXPECT_EQ(
      sealed_contents(goals, {goal_of(1, 1), goal_of(3, 1)}).faults(kRun).differences,
      Lines{
          "2 messages on NEXTVIEW_GOAL were sealed, 2 are there, and not all are what they were"});
}

TEST(LogContents, TimesOtherThanTheSealedOnesAreSaid) {
  LogContents contents;
  LoggedMessage event = event_of(0, goal_of(1, 1));
  contents.add(event);
  const seal_t seal = contents.seal(kRun, 0);
  LogContents anew;
  ++event.received_us;
  anew.add(event);
  anew.add({std::string(Channel<seal_t>::name), encode(seal), 1, event.received_us});
  const LogFaults faults = anew.faults(kRun);
  EXPECT_EQ(faults.differences, Lines{});
  ASSERT_EQ(faults.remarks.size(), 1U);
  EXPECT_NE(faults.remarks[0].find("received at other times"), std::string::npos);
}

TEST(LogContents, ASealOfAnotherRunDoesNotCount) {
  const LogContents contents = sealed_contents({goal_of(1, 1)}, {goal_of(2, 1)});
  EXPECT_TRUE(contents.is_sealed(kRun));
  EXPECT_FALSE(contents.is_sealed(kRun + 1));
  const LogFaults faults = contents.faults(kRun + 1);
  EXPECT_FALSE(faults.sealed);
  EXPECT_EQ(faults.differences, Lines{});
  EXPECT_EQ(faults.remarks.size(), 1U);
}

TEST(LogContents, ChannelsOfALaterVersionAreNotChecked) {
  LogContents contents;
  contents.add({"NEXTVIEW_LATER", {1, 2, 3}, 0, 0});
  contents.add({"SOMEBODY_ELSE", {1, 2, 3}, 1, 0});
  EXPECT_EQ(contents.faults(kRun).missing,
            Lines{"what is said by 1 message on NEXTVIEW_LATER, a channel that this version does "
                  "not know"});
  EXPECT_EQ(contents.faults(kRun).remarks,
            Lines{"there is also 1 message on SOMEBODY_ELSE, which no run has to do with"});
}

}  // namespace
}  // namespace nextview
