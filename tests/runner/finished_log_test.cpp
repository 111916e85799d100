#include "runner/finished_log.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "tests/logger/append_to_log.h"
#include "tests/logger/run_messages.h"

namespace nextview {
namespace {

class FinishedLog : public testing::Test {
 protected:
  FinishedLog() {
    append_to_log(file_, config_message());
    append_to_log(file_, goal_of(1, 1));
    append_to_log(file_, stop_after(0, 0, "interrupted"));
  }
  ~FinishedLog() override { std::filesystem::remove(file_); }

  // Such as an event begins with.
  void append_bytes(int count) {
    const std::string begun("\xED\xA1\xDA\x01\0\0\0\0\0\0\0\0\0\0", 14);
    std::ofstream(file_, std::ios::binary | std::ios::app).write(begun.data(), count);
  }
  std::vector<std::string> finish(bool began_anew) {
    RunLog log(file_, std::nullopt, RangeImages::OnlyCount);
    return finish_log(log, file_, began_anew);
  }
  LogFaults faults() const {
    RunLog log(file_, std::nullopt, RangeImages::OnlyCount);
    log.read_on();
    EXPECT_EQ(log.bytes_left(), 0);
    return log.contents().faults(config_message().run);
  }

  std::filesystem::path file_ = std::filesystem::temp_directory_path() /
                                ("nextview-finished-" + std::to_string(::getpid()) + ".lcmlog");
};

TEST_F(FinishedLog, IsSealed) {
  EXPECT_FALSE(faults().sealed);
  EXPECT_TRUE(finish(false).empty());
  EXPECT_TRUE(faults().sealed);
  EXPECT_EQ(faults().differences, std::vector<std::string>());
}

TEST_F(FinishedLog, LosesTheHalfMessageOfARecorderThatWasKilled) {
  append_bytes(11);
  finish(false);
  EXPECT_TRUE(faults().sealed);
  EXPECT_EQ(faults().differences, std::vector<std::string>());
}

TEST_F(FinishedLog, OfMoreThanOneRecorderTellsWhatContradictsItself) {
  goal_t other = goal_of(1, 1);
  other.fitness = 0.25;
  append_to_log(file_, other);
  EXPECT_TRUE(finish(false).empty());
  const std::vector<std::string> said = finish(true);
  ASSERT_EQ(said.size(), 1U);
  EXPECT_NE(said[0].find("NEXTVIEW_GOAL"), std::string::npos) << said[0];
}

}  // namespace
}  // namespace nextview
