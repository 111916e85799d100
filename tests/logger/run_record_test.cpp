#include "logger/run_record.h"

#include <gtest/gtest.h>

#include "lcmtypes/bus.h"
#include "lcmtypes/timing_message.h"
#include "tests/logger/run_messages.h"

namespace nextview {
namespace {

using Missing = std::vector<MissingMessage>;

RunRecord record_with_config(RangeImages range_images = RangeImages::Keep) {
  RunRecord record(range_images);
  record.add(config_message());
  return record;
}

TEST(RunRecord, OfNothingLacksTheConfigurationAndTheEnd) {
  EXPECT_EQ(RunRecord(RangeImages::Keep).missing(),
            (Missing{{"NEXTVIEW_RUN_CONFIG", 0, 0}, {"NEXTVIEW_STOP", 0, 0}}));
}

TEST(RunRecord, OfAWholeRunLacksNothing) {
  RunRecord record = record_with_config();
  add_view(record, 1, 1);
  add_view(record, 2, 3);
  EXPECT_EQ(record.missing(), (Missing{{"NEXTVIEW_STOP", 0, 0}}));
  record.add(stop_after(2, 0, "view_limit"));
  EXPECT_EQ(record.missing(), Missing{});
  EXPECT_EQ(record.committed_views(), 2);
  EXPECT_EQ(record.latest_view(), 2);
}

TEST(RunRecord, NamesWhatAViewLacks) {
  RunRecord record = record_with_config();
  record.add(goal_of(2, 1));
  record.add(commit_of(2, 2));
  EXPECT_EQ(record.missing_of_view(2), (Missing{{"NEXTVIEW_SEARCH", 2, 1},
                                                {"NEXTVIEW_ARRIVAL", 2, 1},
                                                {"NEXTVIEW_GOAL", 2, 2},
                                                {"NEXTVIEW_SEARCH", 2, 2},
                                                {"NEXTVIEW_ARRIVAL", 2, 2},
                                                {"NEXTVIEW_RANGE_IMAGE", 2, 2}}));
  EXPECT_EQ(record.missing_of_view(1), (Missing{{"NEXTVIEW_COMMIT", 1, 0}}));
  EXPECT_EQ(record.committed_views(), 2);
}

TEST(RunRecord, ViewOneNeedsNoSearch) {
  RunRecord record = record_with_config();
  add_view(record, 1, 1);
  EXPECT_EQ(record.search(1, 1), nullptr);
  EXPECT_EQ(record.missing_of_view(1), Missing{});
}

TEST(RunRecord, AnImageIsMissingUntilItsLastPartHasCome) {
  RunRecord record = record_with_config();
  record.add(goal_of(1, 1));
  record.add(arrival_of(1, 1, true));
  record.add(commit_of(1, 1));
  const std::vector<range_image_t> parts = image_of(1, 1);
  ASSERT_GT(parts.size(), 1u);
  for (const range_image_t& part : parts) {
    EXPECT_EQ(record.missing_of_view(1), (Missing{{"NEXTVIEW_RANGE_IMAGE", 1, 1}}));
    EXPECT_EQ(record.range_image(1, 1), nullptr);
    record.add(part);
  }
  EXPECT_EQ(record.missing_of_view(1), Missing{});
  ASSERT_NE(record.range_image(1, 1), nullptr);
  EXPECT_EQ(record.range_image(1, 1)->image.range_m.size(), 20000u);
}

TEST(RunRecord, KnowsTheTimingsThatHaveComeAndMissesNone) {
  RunRecord record = record_with_config();
  record.add(timing_message("mapper", 0, 2, 1, {{"update", 0.5}, {"digest", 0.25}}));
  record.add(timing_message("planner", 0, 10, 0, {{"fold_before", 0.125}}));
  EXPECT_EQ(record.duration_s(2, 1, "digest"), 0.25);
  EXPECT_EQ(record.duration_s(10, 0, "fold_before"), 0.125) << "of the last view";
  EXPECT_EQ(record.duration_s(2, 1, "scan"), std::nullopt);
  EXPECT_EQ(record.duration_s(2, 2, "update"), std::nullopt);
  EXPECT_EQ(record.latest_view(), 0);
  EXPECT_THROW(record.add(timing_message("planner", 0, 11, 0, {})), RejectedMessage);
}

TEST(RunRecord, AForgottenImageStillCounts) {
  RunRecord record = record_with_config();
  add_view(record, 1, 1);
  record.forget_range_image(1, 1);
  EXPECT_EQ(record.range_image(1, 1), nullptr);
  EXPECT_EQ(record.missing_of_view(1), Missing{});
}

TEST(RunRecord, CountsImagesWithoutKeepingThem) {
  RunRecord record = record_with_config(RangeImages::OnlyCount);
  add_view(record, 1, 1);
  EXPECT_EQ(record.range_image(1, 1), nullptr);
  EXPECT_EQ(record.missing_of_view(1), Missing{});
}

TEST(RunRecord, ARunThatFoundNoGoalNeedsWhatItTried) {
  RunRecord record = record_with_config();
  add_view(record, 1, 1);
  record.add(stop_after(1, 3, "no_feasible_goal"));
  // Two goals were refused and a third was not found, or was refused, too.
  EXPECT_EQ(record.missing(), (Missing{{"NEXTVIEW_GOAL", 2, 1},
                                       {"NEXTVIEW_SEARCH", 2, 1},
                                       {"NEXTVIEW_ARRIVAL", 2, 1},
                                       {"NEXTVIEW_GOAL", 2, 2},
                                       {"NEXTVIEW_SEARCH", 2, 2},
                                       {"NEXTVIEW_ARRIVAL", 2, 2}}));
  for (int attempt = 1; attempt <= 2; ++attempt) {
    record.add(goal_of(2, attempt));
    record.add(search_of(2, attempt));
    record.add(arrival_of(2, attempt, false));
  }
  EXPECT_EQ(record.missing(), Missing{});
  record.add(goal_of(2, 3));
  EXPECT_EQ(record.missing(), (Missing{{"NEXTVIEW_SEARCH", 2, 3}, {"NEXTVIEW_ARRIVAL", 2, 3}}));
}

TEST(RunRecord, RefusesWhatTheRunCannotHave) {
  RunRecord record = record_with_config();
  EXPECT_THROW(record.add(goal_of(10, 1)), RejectedMessage);
  EXPECT_THROW(record.add(search_of(2, 4)), RejectedMessage);
  EXPECT_THROW(record.add(arrival_of(2000000000, 1, true)), RejectedMessage);
  EXPECT_THROW(record.add(commit_of(10, 1)), RejectedMessage);
  EXPECT_THROW(record.add(stop_after(10, 0, "view_limit")), RejectedMessage);
  EXPECT_THROW(record.add(image_of(10, 1).front()), RejectedMessage);
  EXPECT_EQ(record.latest_view(), 0);
  RunRecord without_config(RangeImages::Keep);
  EXPECT_THROW(without_config.add(goal_of(1, 1)), RejectedMessage);
}

TEST(MissingMessage, IsDescribed) {
  EXPECT_EQ(describe(MissingMessage{"NEXTVIEW_GOAL", 3, 1}), "NEXTVIEW_GOAL of view 3, attempt 1");
  EXPECT_EQ(describe(MissingMessage{"NEXTVIEW_COMMIT", 3, 0}), "NEXTVIEW_COMMIT of view 3");
  EXPECT_EQ(describe(MissingMessage{"NEXTVIEW_STOP", 0, 0}), "NEXTVIEW_STOP");
}

}  // namespace
}  // namespace nextview
