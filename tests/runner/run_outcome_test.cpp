#include "runner/run_outcome.h"

#include <gtest/gtest.h>

#include "tests/logger/run_messages.h"

namespace nextview {
namespace {

RunRecord record_that_ends(const std::string& reason) {
  RunRecord record(RangeImages::OnlyCount);
  record.add(config_message());
  add_view(record, 1, 1);
  record.add(stop_after(1, 0, reason));
  return record;
}

TEST(Outcome, IsWhatTheLogSays) {
  FinishedRun run;
  tell_end(record_that_ends("nothing_new"), std::nullopt, run);
  EXPECT_EQ(run.stop_reason, "nothing_new");
}

TEST(Outcome, SaysOfAReasonThatIsNotKnownWhatToDo) {
  FinishedRun run;
  tell_end(record_that_ends("tired"), std::nullopt, run);
  EXPECT_EQ(run.stop_reason, "tired");
  EXPECT_NE(run.stop_detail.find("\"tired\""), std::string::npos) << run.stop_detail;
  EXPECT_NE(run.stop_detail.find("start it with the planner it was built with"), std::string::npos);
}

TEST(Outcome, OfARunThatEndedEarlyIsWhyItDid) {
  RunRecord record(RangeImages::OnlyCount);
  record.add(config_message());
  FinishedRun run;
  tell_end(record, EndsEarly{StopReason::ProcessDied, "mapper died"}, run);
  EXPECT_EQ(run.stop_reason, "process_died");
  EXPECT_EQ(run.stop_detail, "mapper died");
}

TEST(Outcome, DoesNotContradictTheLogWithoutAWord) {
  const EndsEarly early{StopReason::NoAnswer, "the log still lacks a commit"};
  FinishedRun run;
  tell_end(record_that_ends("nothing_new"), early, run);
  EXPECT_EQ(run.stop_reason, "no_answer");
  EXPECT_EQ(run.stop_detail,
            "the log still lacks a commit (the planner had ended the run by then: nothing_new)");
  FinishedRun said_so;
  tell_end(record_that_ends("no_answer"), early, said_so);
  EXPECT_EQ(said_so.stop_detail, early.detail) << "the log says the same";
}

TEST(Outcome, CountsCollisionsApartFromOtherRefusals) {
  RunRecord record(RangeImages::OnlyCount);
  record.add(config_message());
  const auto refuse = [&record](int attempt, const std::string& why) {
    record.add(goal_of(1, attempt));
    arrival_t arrival = arrival_of(1, attempt, false);
    arrival.refusal = why;
    record.add(arrival);
  };
  refuse(1, "collision: 0.1 m from a wall");
  refuse(2, "beyond the lift");
  record.add(goal_of(1, 3));
  record.add(arrival_of(1, 3, true));
  FinishedRun run;
  count_refusals(record, run);
  EXPECT_EQ(run.collisions, 1);
  EXPECT_EQ(run.other_refusals, 1);
}

}  // namespace
}  // namespace nextview
