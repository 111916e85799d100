#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/scene/far_boxes.h"
#include "tests/system/program.h"

namespace nextview {
namespace {

nlohmann::json summary_of(const std::filesystem::path& run) {
  std::ifstream file(run / "summary.json");
  return nlohmann::json::parse(file);
}

// 5400 km north a float tells half metres apart. The run there is to the last bit the one at home.
TEST(Georeferenced, SceneIsRecoveredAsIfItLayAtTheOrigin) {
  const TemporaryFolder folder;
  write_far_boxes(folder / "far.obj", 500e3, 5400e3);
  write_far_boxes(folder / "near.obj", 0.0, 0.0);
  const Outcome far_off =
      run_views(folder / "far", 4,
                {(folder / "far.obj").string(), "--start", "500000.75", "5400001", "1.25"});
  EXPECT_EQ(far_off.status, 0) << far_off.output;
  EXPECT_NE(far_off.output.find("the file's less (500000.00, 5400000.00, 0.00) m"),
            std::string::npos)
      << far_off.output;
  const Outcome near_by = run_views(
      folder / "near", 4, {(folder / "near.obj").string(), "--start", "0.75", "1", "1.25"});
  EXPECT_EQ(near_by.status, 0) << near_by.output;

  const nlohmann::json there = summary_of(folder / "far");
  const nlohmann::json here = summary_of(folder / "near");
  EXPECT_EQ(there.at("scene_origin_in_file_m"), nlohmann::json({500e3, 5400e3, 0.0}));
  EXPECT_EQ(here.at("scene_origin_in_file_m"), nlohmann::json({0.0, 0.0, 0.0}));
  EXPECT_EQ(there.at("views"), here.at("views"));
  EXPECT_EQ(there.at("surface_coverage"), here.at("surface_coverage"));
  EXPECT_EQ(there.at("map_digest"), here.at("map_digest"));
  EXPECT_EQ(replay_folder(folder / "far").status, 0);
}

}  // namespace
}  // namespace nextview
