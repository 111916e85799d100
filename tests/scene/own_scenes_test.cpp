#include <gtest/gtest.h>

#include <cmath>

#include "scene/enclosure.h"
#include "scene/scene_catalog.h"
#include "tests/scene/test_worlds.h"

namespace nextview {
namespace {

struct OwnScene {
  const char* name;
  Eigen::Vector3d size_m;
  double surface_area_m2;  // P25
};

class OwnScenes : public ::testing::TestWithParam<OwnScene> {
 protected:
  SceneDescription description_ = find_scene(GetParam().name, kScenesFolder);
  Scene scene_{load_mesh(description_.file, description_.options)};
};

TEST_P(OwnScenes, HasThePapersInsideSurfaceAndSize) {
  EXPECT_NEAR(scene_.mesh().area_m2(), GetParam().surface_area_m2, 1e-4);
  EXPECT_EQ(description_.surface_area_m2, GetParam().surface_area_m2);
  EXPECT_EQ(description_.triangles, static_cast<std::int64_t>(scene_.mesh().triangles.size()));
  EXPECT_EQ(scene_.mesh().bounds_m().min(), Eigen::Vector3d(0, 0, 0));
  EXPECT_LT((scene_.mesh().bounds_m().max() - GetParam().size_m).norm(), 1e-6);
}

TEST_P(OwnScenes, EverySurfaceLiesAtVoxelCentresOfATenCentimetreLattice) {
  for (const Eigen::Vector3f& vertex : scene_.mesh().vertices_m) {
    for (const float coordinate : vertex) {
      EXPECT_EQ(coordinate, std::round(coordinate * 10.0F) / 10.0F);
    }
  }
}

TEST_P(OwnScenes, IsClosedAndTheStartIsClear) {
  const Eigen::Vector3d start = description_.start_m.value();
  EXPECT_EQ(escape_share(scene_, start), 0.0);
  EXPECT_GT(scene_.clearance_m(start, start, 1.0), 0.5);
}

// No surface is hidden: every triangle has a point that some free position sees.
TEST_P(OwnScenes, EveryTriangleCanBeSeenFromInside) {
  RandomStream random = random_stream(1);
  std::vector<bool> seen(scene_.mesh().triangles.size(), false);
  const Eigen::Vector3d centre = scene_.mesh().bounds_m().center();
  int rays = 0;
  for (int position = 0; position < 200; ++position) {
    const Eigen::Vector3d from =
        centre + random_point(random, 1.0).cwiseProduct(0.5 * GetParam().size_m);
    // Inside a box or a column, none of which has more than 1 m3.
    if (visible_volume_m3(scene_, from) < 2.0) {
      continue;
    }
    for (int i = 0; i < 500; ++i, ++rays) {
      const auto hit = scene_.first_hit(from, random_direction(random));
      ASSERT_TRUE(hit.has_value()) << from.transpose();
      seen[hit->triangle] = true;
    }
  }
  EXPECT_GT(rays, 50000);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_TRUE(seen[i]) << "triangle " << i << " at " << scene_.mesh().corner_m(i, 0).transpose();
  }
}

INSTANTIATE_TEST_SUITE_P(, OwnScenes,
                         ::testing::Values(OwnScene{"boxes", {5.0, 3.0, 3.0}, 89.0},
                                           OwnScene{"columns", {6.0, 4.5, 3.0}, 133.5}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace nextview
