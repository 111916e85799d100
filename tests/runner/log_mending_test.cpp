#include "runner/log_mending.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "tests/lcmtypes/lossy_network.h"
#include "tests/logger/append_to_log.h"
#include "tests/logger/run_messages.h"

namespace nextview {
namespace {

class MendedLog : public testing::Test {
 protected:
  MendedLog() {
    heard_.record.add(config_message());
    add_view(heard_.record, 1, 1);
    heard_.record.add(goal_of(2, 1));
    append(config_message());
    append(goal_of(1, 1));
  }
  ~MendedLog() override { std::filesystem::remove(file_); }

  template <class Message>
  void append(const Message& message) {
    append_to_log(file_, message);
  }
  template <class Message>
  bool is_published(const Message& message) const {
    return std::find(network_.published().begin(), network_.published().end(),
                     std::pair(std::string(Channel<Message>::name), encode(message))) !=
           network_.published().end();
  }

  HeardRun heard_;
  LossyNetwork network_{{}};
  Bus bus_{network_.connect(), config_message().run, "run"};
  std::filesystem::path file_ = std::filesystem::temp_directory_path() /
                                ("nextview-mended-" + std::to_string(::getpid()) + ".lcmlog");
};

TEST_F(MendedLog, GetsWhatItLacks) {
  RunLog log(file_, std::nullopt, RangeImages::OnlyCount);
  LogMending mending;
  mending.begin();
  while (network_.published().empty()) mending.step(log, bus_, heard_);
  EXPECT_TRUE(is_published(arrival_of(1, 1, true)));
  EXPECT_TRUE(is_published(commit_of(1, 1)));
  EXPECT_TRUE(is_published(goal_of(2, 1)));
  EXPECT_FALSE(is_published(goal_of(1, 1))) << "the log has it";
  request_t request{};
  request.run = config_message().run;
  request.wanted_channel = Channel<range_image_t>::name;
  request.view = 1;
  request.attempt = 1;
  request.asker = "run";
  EXPECT_TRUE(is_published(request)) << "of which only the sensor has the bytes";
  EXPECT_TRUE(mending.under_way());

  append(search_of(1, 1));
  append(arrival_of(1, 1, true));
  append(commit_of(1, 1));
  append(goal_of(2, 1));
  for (const range_image_t& part : image_of(1, 1)) append(part);
  while (mending.under_way()) mending.step(log, bus_, heard_);
  EXPECT_TRUE(log.record().missing_of_view(1).empty());
}

TEST_F(MendedLog, IsLeftAloneUntilItsRecorderBeganAnew) {
  RunLog log(file_, std::nullopt, RangeImages::OnlyCount);
  LogMending mending;
  for (int i = 0; i < 100; ++i) mending.step(log, bus_, heard_);
  EXPECT_TRUE(network_.published().empty());
}

}  // namespace
}  // namespace nextview
