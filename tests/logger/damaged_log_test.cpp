// Logs whose bytes are damaged: read past it, and told of.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>

#include "lcmtypes/decode.h"
#include "logger/log_event.h"
#include "logger/log_reader.h"
#include "tests/lcmtypes/allocation_watch.h"

namespace nextview {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes event_of(std::uint64_t number, const std::string& channel, std::size_t data_bytes) {
  Bytes data(data_bytes);
  for (std::size_t i = 0; i < data.size(); ++i) data[i] = static_cast<std::uint8_t>(number + i);
  return encode_event({.number = number, .received_us = 1000}, channel, data);
}

class DamagedLog : public testing::Test {
 protected:
  DamagedLog() {
    for (std::uint64_t i = 0; i < 5; ++i) {
      starts_.push_back(log_.size());
      const Bytes event = event_of(i, "CHANNEL_" + std::to_string(i), 20 + 7 * i);
      log_.insert(log_.end(), event.begin(), event.end());
    }
    starts_.push_back(log_.size());
  }
  ~DamagedLog() override { std::filesystem::remove(file_); }

  void write(const Bytes& bytes) {
    std::ofstream(file_, std::ios::binary | std::ios::trunc)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }

  /// The numbers of the events that are read.
  std::vector<std::uint64_t> numbers(const Bytes& bytes) {
    write(bytes);
    LogReader reader(file_);
    std::vector<std::uint64_t> numbers;
    while (const auto event = reader.next()) numbers.push_back(event->number);
    damaged_ = reader.damaged();
    bytes_left_ = reader.bytes_left();
    return numbers;
  }

  using Numbers = std::vector<std::uint64_t>;
  std::filesystem::path file_ = std::filesystem::temp_directory_path() /
                                ("nextview-damaged-" + std::to_string(::getpid()) + ".lcmlog");
  Bytes log_;
  std::vector<std::size_t> starts_;  // of each event, and the end
  std::vector<DamagedBytes> damaged_;
  std::int64_t bytes_left_ = 0;
};

TEST_F(DamagedLog, IsReadWholeWhereItIsNot) {
  EXPECT_EQ(numbers(log_), (Numbers{0, 1, 2, 3, 4}));
  EXPECT_TRUE(damaged_.empty());
  EXPECT_EQ(bytes_left_, 0);
}

TEST_F(DamagedLog, IsReadUpToWhereItIsCutOffAtAnyByte) {
  for (std::size_t cut = 0; cut < log_.size(); ++cut) {
    const auto whole = std::upper_bound(starts_.begin(), starts_.end(), cut) - starts_.begin() - 1;
    const Numbers read = numbers(Bytes(log_.begin(), log_.begin() + static_cast<long>(cut)));
    EXPECT_EQ(std::ssize(read), whole) << cut;
    EXPECT_EQ(bytes_left_,
              static_cast<std::int64_t>(cut - starts_[static_cast<std::size_t>(whole)]));
    EXPECT_TRUE(damaged_.empty());
  }
}

TEST_F(DamagedLog, IsReadOnPastAnEventWithoutItsSyncWord) {
  for (std::size_t byte = 0; byte < kSyncWordBytes; ++byte) {
    Bytes log = log_;
    log[starts_[2] + byte] ^= 0x10;
    EXPECT_EQ(numbers(log), (Numbers{0, 1, 3, 4}));
    ASSERT_EQ(damaged_.size(), 1u);
    EXPECT_EQ(damaged_[0].position, static_cast<std::int64_t>(starts_[2]));
    EXPECT_EQ(damaged_[0].bytes, static_cast<std::int64_t>(starts_[3] - starts_[2]));
    EXPECT_EQ(bytes_left_, 0);
  }
}

TEST_F(DamagedLog, IsReadOnAfterEveryBitThatIsFlipped) {
  for (std::size_t bit = 0; bit < 8 * starts_[4]; ++bit) {
    Bytes log = log_;
    log[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    const Numbers read = numbers(log);
    ASSERT_FALSE(read.empty()) << bit;
    EXPECT_EQ(read.back(), 4U) << bit;
    EXPECT_GE(read.size(), 4U) << bit << ": one event is hit, and no other lost";
    EXPECT_EQ(bytes_left_, 0) << bit;
  }
}

TEST_F(DamagedLog, IsReadOnPastForeignBytes) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 100; ++i) {
    Bytes log = log_;
    Bytes foreign(1 + random() % 300);
    for (std::uint8_t& byte : foreign) byte = static_cast<std::uint8_t>(random());
    const std::size_t where = starts_[1 + random() % 4];
    log.insert(log.begin() + static_cast<long>(where), foreign.begin(), foreign.end());
    EXPECT_EQ(numbers(log), (Numbers{0, 1, 2, 3, 4}));
    ASSERT_EQ(damaged_.size(), 1u);
    EXPECT_EQ(damaged_[0].bytes, std::ssize(foreign));
  }
}

TEST_F(DamagedLog, AnEventWithoutAChannelIsReadAsOne) {
  Bytes log = event_of(0, "", 4);
  log.insert(log.end(), log_.begin(), log_.end());
  EXPECT_EQ(numbers(log), (Numbers{0, 0, 1, 2, 3, 4}));
  EXPECT_TRUE(damaged_.empty());
}

TEST_F(DamagedLog, ALengthThatIsWrongAllocatesNothing) {
  constexpr std::size_t kMuch = 1024 * 1024;
  for (const std::size_t length_at : {std::size_t{20}, std::size_t{24}}) {
    for (const std::uint8_t high : std::vector<std::uint8_t>{0x7F, 0x80, 0xFF, 0x10}) {
      Bytes log = log_;
      log[starts_[2] + length_at] = high;
      write(log);
      watch_allocations();
      LogReader reader(file_);
      Numbers read;
      while (const auto event = reader.next()) read.push_back(event->number);
      EXPECT_LT(largest_allocation(), kMuch);
      EXPECT_EQ(read, (Numbers{0, 1, 3, 4}));
    }
  }
}

TEST_F(DamagedLog, ThatIsNothingButDamageIsReadToItsEnd) {
  EXPECT_EQ(numbers(Bytes(10000, 0)), Numbers{});
  EXPECT_EQ(bytes_left_, 10000);
  Bytes sync_words;
  for (int i = 0; i < 5000; ++i) {
    for (const std::uint8_t byte : std::vector<std::uint8_t>{0xED, 0xA1, 0xDA, 0x01})
      sync_words.push_back(byte);
  }
  EXPECT_EQ(numbers(sync_words), Numbers{});
}

}  // namespace
}  // namespace nextview
