#include "runner/log_completion.h"

#include <gtest/gtest.h>

#include "tests/lcmtypes/lossy_network.h"
#include "tests/logger/run_messages.h"

namespace nextview {
namespace {

using Lacking = std::set<MissingMessage>;

RunRecord record_of_two_views() {
  RunRecord record(RangeImages::Keep);
  record.add(config_message());
  add_view(record, 1, 1);
  add_view(record, 2, 2);
  return record;
}

TEST(LackingInLog, IsNothingWhenTheLogHasAllThatWasHeard) {
  EXPECT_EQ(lacking_in_log(record_of_two_views(), record_of_two_views()), Lacking{});
}

TEST(LackingInLog, IsWhatWasHeardAndNotLogged) {
  RunRecord heard = record_of_two_views();
  heard.add(goal_of(3, 1));
  heard.add(search_of(3, 1));
  EXPECT_EQ(lacking_in_log(record_of_two_views(), heard),
            (Lacking{{"NEXTVIEW_GOAL", 3, 1}, {"NEXTVIEW_SEARCH", 3, 1}}));
}

TEST(LackingInLog, IsWhatMustHaveBeenSaidThoughNobodyHeardIt) {
  RunRecord logged = record_of_two_views();
  logged.add(goal_of(3, 1));
  logged.add(commit_of(3, 1));
  EXPECT_EQ(
      lacking_in_log(logged, record_of_two_views()),
      (Lacking{
          {"NEXTVIEW_SEARCH", 3, 1}, {"NEXTVIEW_ARRIVAL", 3, 1}, {"NEXTVIEW_RANGE_IMAGE", 3, 1}}));
}

TEST(PublishAgain, SaysTheSameBytesAsWhoSaidThemFirst) {
  const RunRecord heard = record_of_two_views();
  LossyNetwork network({});
  Bus bus(network.connect(), heard.goal(2, 1)->run, "run");
  for (const char* channel : {"NEXTVIEW_GOAL", "NEXTVIEW_SEARCH", "NEXTVIEW_ARRIVAL"}) {
    EXPECT_TRUE(publish_again(bus, {channel, 2, 1}, heard)) << channel;
    EXPECT_TRUE(publish_again(bus, {channel, 2, 1}, heard)) << channel << ", once more";
  }
  EXPECT_TRUE(publish_again(bus, {"NEXTVIEW_COMMIT", 2, 0}, heard));
  const auto& published = network.published();
  ASSERT_EQ(published.size(), 7U);
  EXPECT_EQ(published[0].second, encode(*heard.goal(2, 1)));
  EXPECT_EQ(published[1].second, published[0].second);
  EXPECT_EQ(published[2].second, encode(*heard.search(2, 1)));
  EXPECT_EQ(published[4].second, encode(*heard.arrival(2, 1)));
  EXPECT_EQ(published[6].second, encode(*heard.commit(2)));
}

TEST(PublishAgain, SaysNothingOfWhatIsNotHere) {
  const RunRecord heard = record_of_two_views();
  LossyNetwork network({});
  Bus bus(network.connect(), heard.goal(2, 1)->run, "run");
  EXPECT_FALSE(publish_again(bus, {"NEXTVIEW_GOAL", 3, 1}, heard));
  EXPECT_FALSE(publish_again(bus, {"NEXTVIEW_COMMIT", 3, 0}, heard));
  EXPECT_FALSE(publish_again(bus, {"NEXTVIEW_RANGE_IMAGE", 2, 2}, heard));
  EXPECT_TRUE(network.published().empty());
}

// One end of a run only: what is in the log counts, and then what was heard.
TEST(EndToPublish, IsNeverAnotherThanTheOneThatIsThere) {
  const stop_t recorded = stop_after(2, 0, "nothing_new");
  const stop_t heard = stop_after(3, 0, "view_limit");
  const stop_t own = stop_after(1, 0, "interrupted");
  EXPECT_FALSE(end_to_publish(recorded, heard, own)) << "recorded and heard";
  EXPECT_FALSE(end_to_publish(recorded, std::nullopt, own)) << "recorded, and missed here";
  const auto missed_by_recorder = end_to_publish(std::nullopt, heard, own);
  ASSERT_TRUE(missed_by_recorder) << "heard, and missed by the recorder";
  EXPECT_EQ(encode(*missed_by_recorder), encode(heard));
  const auto of_the_run = end_to_publish(std::nullopt, std::nullopt, own);
  ASSERT_TRUE(of_the_run) << "neither";
  EXPECT_EQ(encode(*of_the_run), encode(own));
}

}  // namespace
}  // namespace nextview
