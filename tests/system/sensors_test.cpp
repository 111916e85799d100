// Every sensor through the simulator, the bus, the map and both strategies, and back out of the
// log.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/system/program.h"

namespace nextview {
namespace {

nlohmann::json summary_of(const std::filesystem::path& folder) {
  std::ifstream file(folder / "summary.json");
  return nlohmann::json::parse(file);
}

void run_and_replay(const std::string& sensor, const std::string& strategy, int views,
                    double least_coverage, const std::vector<std::string>& more = {}) {
  const TemporaryFolder folder;
  std::vector<std::string> options = {"--sensor", sensor, "--strategy", strategy};
  options.insert(options.end(), more.begin(), more.end());
  const Outcome outcome = run_views(folder / "run", views, options);
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const nlohmann::json summary = summary_of(folder / "run");
  EXPECT_GT(summary.at("surface_coverage").get<double>(), least_coverage);
  EXPECT_EQ(summary.at("collisions"), 0);
  const Outcome replay = replay_folder(folder / "run", {"--planner"});
  EXPECT_EQ(replay.status, 0) << replay.output;
  EXPECT_NE(replay.output.find("every one the same"), std::string::npos) << replay.output;
}

// 250 000 points a view: 21 parts.
TEST(Sensors, APanoramaFindsItsWayByTheSurfaceToBeSeen) {
  run_and_replay("panorama", "surface", 4, 0.85);
}

TEST(Sensors, APanoramaFindsItsWayByThePaper) { run_and_replay("panorama", "paper", 3, 0.7); }

TEST(Sensors, ALineStriperFindsItsWayByTheSurfaceToBeSeen) {
  run_and_replay("line_striper", "surface", 5, 0.2);
}

TEST(Sensors, ALineStriperFindsItsWayByThePaper) {
  run_and_replay("line_striper", "paper", 4, 0.1, {"--prediction-rays", "32x16"});
}

TEST(Sensors, AFileIsASensorToo) {
  const TemporaryFolder folder;
  std::ofstream(folder / "half.json") << R"({"geometry": "spherical", "columns": 90, "rows": 40,
      "horizontal_aperture_deg": 180, "vertical_aperture_deg": 80, "range_noise_m": 0.005})";
  run_and_replay((folder / "half.json").string(), "surface", 3, 0.2);
}

TEST(Sensors, OneThatCannotBeIsSaidToBeSo) {
  const TemporaryFolder folder;
  std::ofstream(folder / "bad.json") << R"({"geometry": "spherical", "columns": 90})";
  for (const auto& [sensor, part] :
       {std::pair{std::string("sonar"), "the sensors in"},
        {(folder / "bad.json").string(), "bad.json: lacks \"rows\""}}) {
    const Outcome outcome = run_views(folder / "run", 2, {"--sensor", sensor});
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    EXPECT_NE(outcome.output.find(part), std::string::npos) << outcome.output;
  }
}

}  // namespace
}  // namespace nextview
