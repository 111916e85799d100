#include "runner/earlier_run.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "lcmtypes/program_version.h"
#include "planner/termination.h"
#include "tests/lcmtypes/lossy_network.h"
#include "tests/logger/append_to_log.h"
#include "tests/logger/run_messages.h"

namespace nextview {
namespace {

class EarlierRunOf : public testing::Test {
 protected:
  EarlierRunOf() { config_.program_version = program_version(); }
  ~EarlierRunOf() override { std::filesystem::remove(file_); }

  template <class Message>
  void append(const Message& message) {
    append_to_log(file_, message);
  }
  std::string why_not() {
    try {
      const EarlierRun earlier(file_);
    } catch (const SetupError& error) {
      return error.what();
    }
    return {};
  }
  static request_t request_for(std::string_view channel, int view, int attempt) {
    request_t request{};
    request.wanted_channel = std::string(channel);
    request.view = view;
    request.attempt = attempt;
    return request;
  }

  run_config_t config_ = config_message();
  std::filesystem::path file_ = std::filesystem::temp_directory_path() /
                                ("nextview-earlier-" + std::to_string(::getpid()) + ".lcmlog");
};

TEST_F(EarlierRunOf, ALogAnswersWithTheBytesItHolds) {
  append(config_);
  append(goal_of(1, 1));
  for (const range_image_t& part : image_of(1, 1)) append(part);
  append(goal_of(2, 1));
  append(goal_of(2, 2));
  EarlierRun earlier(file_);
  EXPECT_EQ(earlier.record().latest_view(), 2);
  LossyNetwork network({});
  Bus bus(network.connect(), config_.run, "run");
  bus.publish(config_);
  const auto& published = network.published();
  earlier.answer(bus, request_for("NEXTVIEW_GOAL", 2, 0));
  ASSERT_EQ(published.size(), 3U);
  EXPECT_EQ(published[1].second, encode(goal_of(2, 1)));
  EXPECT_EQ(published[2].second, encode(goal_of(2, 2)));
  earlier.answer(bus, request_for("NEXTVIEW_GOAL", 2, 2));
  ASSERT_EQ(published.size(), 4U);
  EXPECT_EQ(published[3].second, encode(goal_of(2, 2)));
  earlier.answer(bus, request_for("NEXTVIEW_RANGE_IMAGE", 1, 0));
  ASSERT_EQ(published.size(), 4U + image_of(1, 1).size());
  EXPECT_EQ(published[4].second, encode(image_of(1, 1)[0]));
  earlier.answer(bus, request_for("NEXTVIEW_GOAL", 3, 0));
  earlier.answer(bus, request_for("NEXTVIEW_ARRIVAL", 2, 0));
  EXPECT_EQ(published.size(), 4U + image_of(1, 1).size()) << "what it does not hold";
  EXPECT_EQ(bus.remembered_bytes(), encode(config_).size()) << "the log holds them";
}

TEST_F(EarlierRunOf, ALogTellsWhatWasSaid) {
  append(config_);
  append(goal_of(1, 1));
  append(arrival_of(1, 1, true));
  goal_t of_another_run = goal_of(2, 1);
  of_another_run.run = config_.run + 1;
  append(of_another_run);
  EarlierRun earlier(file_);
  RunRecord told(RangeImages::Keep);
  told.add(earlier.config());
  earlier.tell([&told](const auto& message) { told.add(message); });
  EXPECT_NE(told.goal(1, 1), nullptr);
  EXPECT_NE(told.arrival(1, 1), nullptr);
  EXPECT_EQ(told.latest_view(), 1);
}

TEST_F(EarlierRunOf, ALogLosesAnEndOfTheRunsOwn) {
  append(config_);
  append(goal_of(1, 1));
  const auto size = std::filesystem::file_size(file_);
  append(stop_after(0, 0, std::string(to_string(StopReason::Interrupted))));
  append(goal_of(2, 1));
  const EarlierRun earlier(file_);
  EXPECT_FALSE(earlier.record().stop());
  EXPECT_FALSE(earlier.is_whole());
  EXPECT_EQ(std::filesystem::file_size(file_), size);
}

TEST_F(EarlierRunOf, ALogKeepsThePlannersEnd) {
  append(config_);
  append(goal_of(1, 1));
  append(arrival_of(1, 1, true));
  for (const range_image_t& part : image_of(1, 1)) append(part);
  append(stop_after(1, 0, std::string(to_string(StopReason::NothingLeft))));
  {
    const EarlierRun earlier(file_);
    EXPECT_TRUE(earlier.record().stop());
    EXPECT_FALSE(earlier.is_whole()) << "it lacks a commit";
  }
  append(commit_of(1, 1));
  EXPECT_TRUE(EarlierRun(file_).is_whole());
}

TEST_F(EarlierRunOf, ALogOfAnotherVersionIsAnError) {
  config_.program_version = "0.0 of long ago";
  append(config_);
  EXPECT_NE(why_not().find("was begun by nextview 0.0 of long ago; this is "), std::string::npos)
      << why_not();
}

TEST_F(EarlierRunOf, ALogWithoutAConfigurationIsAnError) {
  append(goal_of(1, 1));
  EXPECT_NE(why_not().find("holds no run's configuration"), std::string::npos) << why_not();
}

}  // namespace
}  // namespace nextview
