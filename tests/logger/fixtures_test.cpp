// Logs that earlier versions have left, see fixtures/README.md.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "logger/replay.h"

namespace nextview {
namespace {

constexpr const char* kFolder = NEXTVIEW_SOURCE_DIR "/tests/logger/fixtures";
constexpr std::uintmax_t kLargest = 300 * 1000;

/// Logs of planners that decided otherwise: their maps must come out the same all the same.
const std::set<std::string> kDecidedOtherwise = {"paper-1", "surface-1"};

/// Logs of versions that seal them.
const std::set<std::string> kSealed = {"paper-3", "surface-3"};

std::vector<std::string> lines_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

void expect_replayed_to_its_digests(const std::filesystem::path& file) {
  EXPECT_LT(std::filesystem::file_size(file), kLargest) << file;
  RunLog log(file, std::nullopt, RangeImages::Keep);
  log.read_on();
  EXPECT_TRUE(log.dropped().empty()) << file << ": " << log.dropped().front();
  const bool planner = !kDecidedOtherwise.contains(file.stem().string());
  const ReplayReport report = replay(log, {.planner = planner});
  EXPECT_EQ(report.differences, std::vector<std::string>{}) << file;
  EXPECT_EQ(report.missing, std::vector<std::string>{}) << file;
  EXPECT_EQ(report.sealed, kSealed.contains(file.stem().string())) << file;

  std::vector<std::string> digests;
  for (const auto& [view, commit] : log.record().commits()) digests.push_back(commit.map_digest);
  const auto file_of_digests = std::filesystem::path(file).replace_extension(".digests");
  EXPECT_EQ(digests, lines_of(file_of_digests)) << file;
  EXPECT_EQ(report.views, std::ssize(digests)) << file;
  EXPECT_EQ(report.goals, planner ? report.views - 1 : 0) << file;
}

TEST(Fixtures, AreReplayedToTheirDigests) {
  int logs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
    if (entry.path().extension() != ".lcmlog") continue;
    expect_replayed_to_its_digests(entry.path());
    ++logs;
  }
  EXPECT_GE(logs, 6);
}

}  // namespace
}  // namespace nextview
