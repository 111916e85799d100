#include "logger/run_log.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <lcm/lcm-cpp.hpp>

#include "lcmtypes/decode.h"
#include "tests/lcmtypes/examples.h"
#include "tests/logger/run_messages.h"

namespace nextview {
namespace {

/// A log a test writes message by message.
class WrittenLog : public testing::Test {
 protected:
  WrittenLog()
      : file_(std::filesystem::temp_directory_path() /
              ("nextview-run-log-" + std::to_string(::getpid()) + ".lcmlog")),
        log_(std::make_unique<lcm::LogFile>(file_.string(), "w")) {}
  ~WrittenLog() override { std::filesystem::remove(file_); }

  void write_bytes(std::string_view channel, std::vector<std::uint8_t> bytes) {
    lcm::LogEvent event;
    event.channel = std::string(channel);
    event.timestamp = 0;
    event.data = bytes.data();
    event.datalen = static_cast<int>(bytes.size());
    log_->writeEvent(&event);
    std::fflush(log_->getFilePtr());
  }

  template <class Message>
  void write(const Message& message) {
    write_bytes(Channel<Message>::name, encode(message));
  }

  RunLog read(std::optional<std::int64_t> run = std::nullopt) {
    RunLog log(file_, run, RangeImages::Keep);
    log.read_on();
    return log;
  }

  std::filesystem::path file_;
  std::unique_ptr<lcm::LogFile> log_;
};

TEST_F(WrittenLog, IsReadAsItGrows) {
  RunLog log(file_, std::nullopt, RangeImages::Keep);
  log.read_on();
  EXPECT_FALSE(log.record().config());
  write(config_message());
  log.read_on();
  EXPECT_TRUE(log.record().config());
  write(goal_of(1, 1));
  log.read_on();
  log.read_on();
  EXPECT_NE(log.record().goal(1, 1), nullptr);
  EXPECT_EQ(log.counters().messages, 2);
  EXPECT_EQ(log.counters().ours, 2);
  EXPECT_EQ(log.counters().repeated, 0);
}

TEST_F(WrittenLog, AMessageHalfWrittenIsReadWhenItIsWhole) {
  write(config_message());
  write(goal_of(1, 1));
  log_.reset();
  std::ifstream in(file_, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), {});
  for (std::size_t cut = 0; cut < bytes.size(); ++cut) {
    std::ofstream(file_, std::ios::binary | std::ios::trunc) << bytes.substr(0, cut);
    RunLog log(file_, std::nullopt, RangeImages::Keep);
    log.read_on();
    EXPECT_EQ(log.record().goal(1, 1), nullptr) << cut;
    if (!log.record().config()) {
      EXPECT_EQ(log.bytes_left(), static_cast<std::int64_t>(cut));
    }
    std::ofstream(file_, std::ios::binary | std::ios::app) << bytes.substr(cut);
    log.read_on();
    EXPECT_NE(log.record().goal(1, 1), nullptr) << cut;
    EXPECT_EQ(log.bytes_left(), 0) << cut;
  }
}

TEST_F(WrittenLog, MessagesBeforeTheConfigurationCount) {
  write(goal_of(1, 1));
  write(config_message());
  EXPECT_NE(read().record().goal(1, 1), nullptr);
}

TEST_F(WrittenLog, ForeignMessagesAreCounted) {
  write(config_message());
  goal_t of_another_run = goal_of(1, 1);
  ++of_another_run.run;
  write(of_another_run);
  write_bytes("SOMEBODY_ELSE", {1, 2, 3});
  write_bytes("LCM_SELF_TEST", {1, 2, 3});
  const RunLog log = read();
  EXPECT_EQ(log.counters().foreign, 2);
  EXPECT_EQ(log.counters().ours, 1);
  EXPECT_EQ(log.record().goal(1, 1), nullptr);
}

// As lcm-logger writes it of a datagram with an empty name, at which LCM's own reader stops.
TEST_F(WrittenLog, IsReadPastAMessageOnAChannelWithoutAName) {
  write(config_message());
  std::FILE* file = log_->getFilePtr();
  const auto write_nameless = [file](std::size_t bytes, std::size_t written) {
    std::vector<std::uint8_t> event = {0xED, 0xA1, 0xDA, 0x01};
    event.resize(27);  // number, time, and no name
    event.push_back(static_cast<std::uint8_t>(bytes));
    event.resize(event.size() + written, 0xFF);
    std::fwrite(event.data(), event.size(), 1, file);
    std::fflush(file);
  };
  write_nameless(3, 3);
  write_nameless(0, 0);
  write(goal_of(1, 1));
  const RunLog log = read();
  EXPECT_TRUE(log.record().config());
  EXPECT_NE(log.record().goal(1, 1), nullptr);
  EXPECT_EQ(log.counters().foreign, 2);
  EXPECT_EQ(log.counters().messages, 4);
  EXPECT_EQ(log.bytes_left(), 0);
  write_nameless(9, 4);
  EXPECT_EQ(read().bytes_left(), 32) << "half of one is none";
}

TEST_F(WrittenLog, OtherRunsAreNamedAndOneCanBeChosen) {
  run_config_t other = config_message();
  other.run += 5;
  write(config_message());
  write(other);
  EXPECT_EQ(read().other_runs(), std::vector<std::int64_t>{other.run});
  EXPECT_EQ(read(other.run).record().config()->run, other.run);
}

TEST_F(WrittenLog, RepeatedMessagesAreCountedWhenTheyAreTheSame) {
  write(config_message());
  write(goal_of(1, 1));
  write(goal_of(1, 1));
  const RunLog log = read();
  EXPECT_EQ(log.counters().repeated, 1);
  EXPECT_TRUE(log.contradictions().empty());
}

TEST_F(WrittenLog, RepeatedMessagesThatDifferAreAContradiction) {
  write(config_message());
  write(goal_of(1, 1));
  goal_t other = goal_of(1, 1);
  other.fitness += 0.125;
  write(other);
  const RunLog log = read();
  ASSERT_EQ(log.contradictions().size(), 1u);
  EXPECT_EQ(log.contradictions()[0],
            "NEXTVIEW_GOAL of view 1, attempt 1 is there twice, and the two differ");
}

TEST_F(WrittenLog, MessagesThatCannotBeRightAreDropped) {
  write(config_message());
  write_bytes(Channel<goal_t>::name, {1, 2, 3});
  write(goal_of(100, 1));
  const RunLog log = read();
  EXPECT_EQ(log.dropped().size(), 2u);
  EXPECT_EQ(log.record().latest_view(), 0);
}

TEST(LogReader, RefusesWhatIsNotThere) {
  EXPECT_THROW(LogReader{"/no/such/log"}, LogError);
  EXPECT_THROW(LogReader{std::filesystem::temp_directory_path()}, LogError);
}

}  // namespace
}  // namespace nextview
