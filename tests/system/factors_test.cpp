// The secondary criteria of the fitness through the bus, into the table, and back out of the log.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/system/program.h"

namespace nextview {
namespace {

void expect_replay_agrees(const std::filesystem::path& folder) {
  const Outcome replay = replay_folder(folder, {"--planner"});
  EXPECT_EQ(replay.status, 0) << replay.output;
  EXPECT_NE(replay.output.find("every one the same"), std::string::npos) << replay.output;
}

// A column of the views that were decided on.
std::vector<std::string> decided(const std::filesystem::path& folder, const std::string& column) {
  std::vector<std::string> values = column_of_views(folder, column);
  EXPECT_EQ(values.front(), "") << "the start was not decided on";
  values.erase(values.begin());
  return values;
}

// The fitness is the product of what the table says.
TEST(Factors, AreInTheTableAndDecidedAgainByAReplay) {
  const TemporaryFolder folder;
  const Outcome run =
      run_views(folder / "run", 6,
                {"--strategy", "paper", "--structure-weight", "2", "--navigation-weight", "0.5"});
  ASSERT_EQ(run.status, 0) << run.output;
  const auto number = [&](const std::string& column) {
    std::vector<double> numbers;
    for (const std::string& text : decided(folder / "run", column))
      numbers.push_back(std::stod(text));
    return numbers;
  };
  const auto fitness = number("fitness");
  const auto structure = number("structure_factor");
  const auto navigation = number("navigation_factor");
  const auto ov = number("share_occupied");
  const auto op = number("share_occlusion_plane");
  const auto us = number("share_unseen");
  for (std::size_t i = 0; i < fitness.size(); ++i) {
    const double area = (5.0 * ov[i] * ov[i] * ov[i] - 10.5 * ov[i] * ov[i] + 6.0 * ov[i]) *
                        (1.0 - std::abs(op[i] - us[i]) / 2.0);
    EXPECT_NEAR(fitness[i], area * (1.0 + 2.0 * structure[i]) * (1.0 + 0.5 * navigation[i]), 1e-4);
  }
  EXPECT_GT(*std::ranges::max_element(structure), 0.0);
  EXPECT_LT(*std::ranges::min_element(navigation), 1.0);
  expect_replay_agrees(folder / "run");
}

TEST(Factors, AreBlankWhereTheyAreOff) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_views(folder / "run", 3, {"--strategy", "paper"}).status, 0);
  for (const char* column : {"structure_factor", "navigation_factor"}) {
    for (const std::string& value : decided(folder / "run", column)) EXPECT_EQ(value, "");
  }
}

void expect_surfaces_count(const std::string& strategy, const std::string& directions) {
  const TemporaryFolder folder;
  const Outcome run = run_views(folder / "run", 4,
                                {"--strategy", strategy, "--directions", directions, "--quality",
                                 "--structure-weight", "1", "--threads", "2"});
  ASSERT_EQ(run.status, 0) << run.output;
  for (const char* column : {"quality_factor", "structure_factor"}) {
    double sum = 0.0;
    for (const std::string& value : decided(folder / "run", column)) sum += std::stod(value);
    EXPECT_GT(sum, 0.0) << column;
  }
  expect_replay_agrees(folder / "run");
}

// More than 20 directions are answered by a panorama.
TEST(Factors, CountInEveryDirection) { expect_surfaces_count("paper", "80"); }

TEST(Factors, CountWhereDirectionsAreRefined) { expect_surfaces_count("paper_refined", "1280"); }

TEST(Factors, AreRefusedByAnotherStrategy) {
  const TemporaryFolder folder;
  const Outcome run =
      run_views(folder / "run", 3, {"--strategy", "surface", "--navigation-weight", "1"});
  EXPECT_EQ(run.status, 1) << run.output;
  EXPECT_NE(run.output.find("--navigation-weight"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("--strategy paper"), std::string::npos) << run.output;
}

}  // namespace
}  // namespace nextview
