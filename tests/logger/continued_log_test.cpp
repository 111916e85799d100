// A log that a second recorder has gone on with.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <lcm/lcm-cpp.hpp>

#include "lcmtypes/decode.h"
#include "logger/event_numbers.h"
#include "logger/run_log.h"
#include "tests/logger/append_to_log.h"
#include "tests/logger/run_messages.h"

namespace nextview {
namespace {

class ContinuedLog : public testing::Test {
 protected:
  ~ContinuedLog() override { std::filesystem::remove(file_); }

  template <class Message>
  void append(const Message& message) {
    append_to_log(file_, message);
  }
  /// As a recorder does that is killed while it writes.
  template <class Message>
  void append_half(const Message& message) {
    const auto before = std::filesystem::file_size(file_);
    append(message);
    const auto after = std::filesystem::file_size(file_);
    std::filesystem::resize_file(file_, (before + after) / 2);
  }
  std::vector<std::int64_t> numbers() {
    lcm::LogFile log(file_.string(), "r");
    std::vector<std::int64_t> numbers;
    while (const lcm::LogEvent* event = log.readNextEvent()) numbers.push_back(event->eventnum);
    return numbers;
  }

  std::filesystem::path file_ = std::filesystem::temp_directory_path() /
                                ("nextview-continued-" + std::to_string(::getpid()) + ".lcmlog");
};

TEST_F(ContinuedLog, IsReadOnWhereAHalfMessageWasCutOff) {
  append(config_message());
  append(goal_of(1, 1));
  append_half(goal_of(2, 1));
  RunLog log(file_, std::nullopt, RangeImages::Keep);
  log.read_on();
  EXPECT_GT(log.bytes_left(), 0);
  log.cut_rest();
  EXPECT_EQ(log.bytes_left(), 0);
  append(goal_of(3, 1));
  append(arrival_of(1, 1, true));
  log.read_on();
  EXPECT_EQ(log.bytes_left(), 0);
  EXPECT_NE(log.record().goal(1, 1), nullptr);
  EXPECT_EQ(log.record().goal(2, 1), nullptr);
  ASSERT_NE(log.record().goal(3, 1), nullptr);
  EXPECT_EQ(encode(*log.record().goal(3, 1)), encode(goal_of(3, 1)));
  EXPECT_NE(log.record().arrival(1, 1), nullptr);
}

TEST_F(ContinuedLog, IsCutOffNowhereWhenItIsWhole) {
  append(config_message());
  const auto size = std::filesystem::file_size(file_);
  RunLog log(file_, std::nullopt, RangeImages::Keep);
  log.read_on();
  log.cut_rest();
  EXPECT_EQ(std::filesystem::file_size(file_), size);
}

TEST_F(ContinuedLog, IsNumberedThrough) {
  for (int view = 1; view <= 4; ++view) append(goal_of(view, 1));
  ASSERT_EQ(numbers(), (std::vector<std::int64_t>{0, 0, 0, 0})) << "each by a recorder of its own";
  number_events(file_);
  EXPECT_EQ(numbers(), (std::vector<std::int64_t>{0, 1, 2, 3}));
  append_half(goal_of(5, 1));
  const auto size = std::filesystem::file_size(file_);
  number_events(file_);
  EXPECT_EQ(numbers(), (std::vector<std::int64_t>{0, 1, 2, 3}));
  EXPECT_EQ(std::filesystem::file_size(file_), size);
}

TEST_F(ContinuedLog, ThatIsNotThereCannotBeNumbered) {
  EXPECT_THROW(number_events("/no/such/file"), LogError);
}

}  // namespace
}  // namespace nextview
