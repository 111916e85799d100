#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <iterator>
#include <lcm/lcm-cpp.hpp>

#include "lcmtypes/decode.h"
#include "tests/system/program.h"

namespace nextview {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// What stands in the place of a logged message: itself, another, nothing, or several.
using Instead = std::vector<Bytes>;
using Tamper = std::function<Instead(const lcm::LogEvent& event, const Bytes& bytes)>;

/// The log of a short run, and copies of it that somebody has tampered with.
class RecordedRun : public testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(run_views(folder_ / "run", 6).status, 0); }

  std::filesystem::path tampered(const Tamper& tamper) {
    std::filesystem::create_directories(folder_ / "tampered");
    lcm::LogFile from((folder_ / "run" / "run.lcmlog").string(), "r");
    lcm::LogFile to((folder_ / "tampered" / "run.lcmlog").string(), "w");
    while (const lcm::LogEvent* read = from.readNextEvent()) {
      lcm::LogEvent event = *read;
      const auto* data = static_cast<const std::uint8_t*>(read->data);
      for (Bytes& bytes : tamper(*read, Bytes(data, data + read->datalen))) {
        event.data = bytes.data();
        event.datalen = static_cast<int>(bytes.size());
        to.writeEvent(&event);
      }
    }
    return folder_ / "tampered";
  }

  template <class Message>
  static bool is_view(const lcm::LogEvent& event, const Bytes& bytes, int view) {
    if (event.channel != Channel<Message>::name) return false;
    return decode_checked<Message>(bytes).message.value().view == view;
  }

  /// A copy in which the messages of a type and view have been edited.
  template <class Message>
  std::filesystem::path edited(int view, const std::function<void(Message&)>& edit) {
    return tampered([&](const lcm::LogEvent& event, const Bytes& bytes) {
      if (!is_view<Message>(event, bytes, view)) return Instead{bytes};
      Message message = *decode_checked<Message>(bytes).message;
      edit(message);
      return Instead{encode(message)};
    });
  }

  static void expect_disagreement(const Outcome& replay, const std::string& words) {
    expect_outcome(replay, 1, words);
  }
  static void expect_lack(const Outcome& replay, const std::string& words) {
    expect_outcome(replay, 3, words);
  }
  static void expect_outcome(const Outcome& replay, int status, const std::string& words) {
    EXPECT_EQ(replay.status, status) << replay.output;
    EXPECT_NE(replay.output.find(words), std::string::npos) << replay.output;
  }

  TemporaryFolder folder_;
};

TEST_F(RecordedRun, Agrees) {
  const Outcome replay = replay_folder(folder_ / "run");
  EXPECT_EQ(replay.status, 0) << replay.output;
  EXPECT_NE(replay.output.find("6 views replayed"), std::string::npos) << replay.output;
}

TEST_F(RecordedRun, AgreesWithThePlannerToo) {
  const Outcome replay = replay_folder(folder_ / "run", {"--planner"});
  EXPECT_EQ(replay.status, 0) << replay.output;
  EXPECT_NE(replay.output.find("5 goals decided again, every one the same"), std::string::npos)
      << replay.output;
}

TEST_F(RecordedRun, AgreesWhenMessagesCameTwice) {
  const auto folder = tampered([](const lcm::LogEvent&, const Bytes& bytes) {
    return Instead{bytes, bytes};
  });
  EXPECT_EQ(replay_folder(folder).status, 0);
}

TEST_F(RecordedRun, ARangeThatWasChangedIsFound) {
  const auto folder = edited<range_image_t>(4, [](range_image_t& image) {
    for (float& range_m : image.range_m) range_m *= 0.5F;
  });
  expect_disagreement(replay_folder(folder), "NEXTVIEW_COMMIT of view 4 differs in ");
}

TEST_F(RecordedRun, AnImageThatWasChangedWhereTheMapDoesNotLookIsFound) {
  const auto folder = edited<range_image_t>(4, [](range_image_t& image) { image.pan_rad += 1e-6; });
  expect_disagreement(replay_folder(folder),
                      "NEXTVIEW_COMMIT of view 4 differs in pan_rad, history_digest");
}

TEST_F(RecordedRun, AMessageLeftOutIsFound) {
  const auto without_commit = tampered([](const lcm::LogEvent& event, const Bytes& bytes) {
    return is_view<commit_t>(event, bytes, 3) ? Instead{} : Instead{bytes};
  });
  expect_lack(replay_folder(without_commit), "the log lacks NEXTVIEW_COMMIT of view 3");
  const auto without_image = tampered([](const lcm::LogEvent& event, const Bytes& bytes) {
    return is_view<range_image_t>(event, bytes, 2) ? Instead{} : Instead{bytes};
  });
  expect_lack(replay_folder(without_image), "the log lacks NEXTVIEW_RANGE_IMAGE of view 2");
}

TEST_F(RecordedRun, AGoalThatWasChangedIsFoundByThePlanner) {
  const auto folder = edited<goal_t>(5, [](goal_t& goal) { goal.fitness += 1e-9; });
  // The map does not depend on it; the seal of the log knows.
  const Outcome without_planner = replay_folder(folder);
  EXPECT_EQ(without_planner.status, 1);
  EXPECT_NE(without_planner.output.find("messages on NEXTVIEW_GOAL were sealed"), std::string::npos)
      << without_planner.output;
  EXPECT_NE(without_planner.output.find(
                "NEXTVIEW_GOAL (decided again with --planner only): waypoints factors fitness"),
            std::string::npos)
      << without_planner.output;
  expect_disagreement(replay_folder(folder, {"--planner"}),
                      "NEXTVIEW_GOAL of view 5, attempt 1 differs in fitness");
}

TEST_F(RecordedRun, WhatNothingDependsOnIsFoundByTheSeal) {
  bool changed = false;
  const auto folder = tampered([&](const lcm::LogEvent& event, const Bytes& bytes) {
    if (event.channel != Channel<timing_t>::name || std::exchange(changed, true)) {
      return Instead{bytes};
    }
    timing_t timing = *decode_checked<timing_t>(bytes).message;
    timing.duration_s.back() += 1.0;
    return Instead{encode(timing)};
  });
  expect_disagreement(replay_folder(folder), "messages on NEXTVIEW_TIMING were sealed");
}

TEST_F(RecordedRun, AMessageThatNobodyMissesIsMissedByTheSeal) {
  bool left_out = false;
  const auto folder = tampered([&](const lcm::LogEvent& event, const Bytes& bytes) {
    if (event.channel != Channel<timing_t>::name || std::exchange(left_out, true)) {
      return Instead{bytes};
    }
    return Instead{};
  });
  expect_lack(replay_folder(folder), "messages on NEXTVIEW_TIMING were sealed");
}

TEST_F(RecordedRun, IsReplayedInTheFilesItWasSplitInto) {
  const auto log = folder_ / "run" / "run.lcmlog";
  std::ifstream in(log, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), {});
  // Where an event ends: before the sync word of the next.
  const std::string sync_word("\xED\xA1\xDA\x01", 4);
  const std::size_t first = bytes.find(sync_word, bytes.size() / 3);
  const std::size_t second = bytes.find(sync_word, 2 * bytes.size() / 3);
  const std::vector<std::string> parts = {
      bytes.substr(0, first), bytes.substr(first, second - first), bytes.substr(second)};
  const auto write_as = [&](const std::vector<std::string>& names) {
    const auto folder = folder_ / names.front();
    std::filesystem::create_directories(folder);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      std::ofstream(folder / names[i], std::ios::binary) << parts[i];
    }
    return folder;
  };
  // Counted up, as by lcm-logger -i; and rotated, where the latest has the lowest number.
  EXPECT_EQ(replay_folder(write_as({"run.lcmlog.00", "run.lcmlog.01", "run.lcmlog.02"})).status, 0);
  const auto rotated = write_as({"run.lcmlog.2", "run.lcmlog.1", "run.lcmlog.0"});
  const Outcome replay = replay_folder(rotated);
  EXPECT_EQ(replay.status, 0) << replay.output;
  std::filesystem::remove(rotated / "run.lcmlog.1");
  expect_lack(replay_folder(rotated), "by its numbers");
}

TEST_F(RecordedRun, TwoMessagesThatContradictEachOtherAreFound) {
  const auto folder = tampered([](const lcm::LogEvent& event, const Bytes& bytes) {
    if (event.channel != Channel<commit_t>::name) return Instead{bytes};
    commit_t commit = *decode_checked<commit_t>(bytes).message;
    commit.mean_quality *= 0.5;
    return Instead{bytes, encode(commit)};
  });
  expect_disagreement(replay_folder(folder), "is there twice, and the two differ");
}

TEST_F(RecordedRun, AMessageThatCannotBeRightIsLeftOut) {
  bool broken = false;
  const auto folder = tampered([&](const lcm::LogEvent& event, const Bytes& bytes) {
    if (!is_view<commit_t>(event, bytes, 2)) return Instead{bytes};
    broken = true;
    return Instead{Bytes(bytes.begin(), bytes.end() - 3)};
  });
  ASSERT_TRUE(broken);
  const Outcome replay = replay_folder(folder);
  expect_disagreement(replay, "the log lacks NEXTVIEW_COMMIT of view 2");
  EXPECT_NE(replay.output.find("left out: a message on NEXTVIEW_COMMIT cannot be right"),
            std::string::npos)
      << replay.output;
}

TEST_F(RecordedRun, ALogThatWasCutOffIsFound) {
  const auto log = folder_ / "run" / "run.lcmlog";
  std::filesystem::resize_file(log, std::filesystem::file_size(log) / 2);
  const Outcome replay = replay_folder(folder_ / "run");
  expect_lack(replay, "the log lacks NEXTVIEW_STOP");
  EXPECT_NE(replay.output.find("are no whole message"), std::string::npos) << replay.output;
}

TEST_F(RecordedRun, ALogWithoutConfigurationIsFound) {
  const auto folder = tampered([](const lcm::LogEvent& event, const Bytes& bytes) {
    return event.channel == Channel<run_config_t>::name ? Instead{} : Instead{bytes};
  });
  expect_disagreement(replay_folder(folder), "no run's configuration is in the log");
}

TEST(NoLog, IsSaidSo) {
  const TemporaryFolder folder;
  Outcome replay = replay_folder(folder / "nowhere");
  EXPECT_EQ(replay.status, 1);
  EXPECT_NE(replay.output.find("nowhere: no such folder"), std::string::npos) << replay.output;
  replay = replay_folder(folder.path());
  EXPECT_EQ(replay.status, 1);
  EXPECT_NE(replay.output.find("run.lcmlog: no such file"), std::string::npos) << replay.output;
  std::ofstream(folder / "run.lcmlog") << "this is no log";
  replay = replay_folder(folder.path());
  EXPECT_EQ(replay.status, 1);
  EXPECT_NE(replay.output.find("no run's configuration"), std::string::npos) << replay.output;
}

}  // namespace
}  // namespace nextview
