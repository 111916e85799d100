#include <gtest/gtest.h>

#include <cmath>

#include "scene/enclosure.h"
#include "scene/scene_catalog.h"
#include "sensor_sim/scan.h"
#include "tests/scene/test_worlds.h"

namespace nextview {
namespace {

struct SharedScene {
  const char* name;
  /// Triangles of no area and exact duplicates, most of them only since coordinates are rounded.
  int left_out;
  double left_out_m2;  // of duplicates
};

class SharedScenes : public ::testing::TestWithParam<SharedScene> {};

TEST_P(SharedScenes, LoadsAsDocumentedAndScansFromItsStart) {
  const auto folder = kSharedScenesFolder / GetParam().name;
  if (!std::filesystem::exists(folder)) {
    GTEST_SKIP() << folder << " is not here: the real model " << GetParam().name
                 << " was NOT tested";
  }
  const SceneDescription description = find_scene(folder.string(), kScenesFolder);
  const Scene scene(load_mesh(description.file, description.options));
  EXPECT_EQ(static_cast<std::int64_t>(scene.mesh().triangles.size()) + GetParam().left_out,
            description.triangles.value());
  EXPECT_NEAR(scene.mesh().area_m2() + GetParam().left_out_m2, description.surface_area_m2.value(),
              0.05);

  const Eigen::Vector3d start = description.start_m.value();
  EXPECT_GT(scene.clearance_m(start, start, 2.0), 1.0);
  EXPECT_LT(escape_share(scene, start), 0.001);
  RandomStream unused = random_stream(1);
  const RangeImage image =
      scan(scene, make_ray_table(TiltedLineScan::paper()), {}, {start, 0.0, 0.0}, 0.0, unused);
  int returns = 0;
  for (const float range_m : image.range_m) {
    returns += std::isfinite(range_m) ? 1 : 0;
  }
  EXPECT_GT(returns, 1900);  // of 64 x 30
}

INSTANTIATE_TEST_SUITE_P(, SharedScenes,
                         ::testing::Values(SharedScene{"conference", 9529, 0.0},
                                           SharedScene{"small_house", 146, 0.0},
                                           SharedScene{"cpr_office", 40, 0.65}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace nextview
