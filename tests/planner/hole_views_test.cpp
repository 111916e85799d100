#include "planner/hole_views.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include "mapper/integer_line.h"
#include "sensor/sensor_geometry.h"

namespace nextview {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// A room of 21 x 20 x 12 voxels, walls included, that is known but for patches of its far wall, at
// j = 19. The robot is near the other one.
class RoomWithHoles : public ::testing::Test {
 protected:
  RoomWithHoles()
      : map({0.1, Eigen::Vector3d::Zero()}, {VoxelIndex::Zero(), VoxelIndex(21, 20, 12)}) {
    for_each_voxel(map.window(), [&](const VoxelIndex& v) {
      const bool wall = (v.array() == 0).any() || v[0] == 20 || v[1] == 19 || v[2] == 11;
      map.set_label(v, wall ? Label::Occupied : Label::Empty);
    });
    parameters.field = {.azimuth_min_rad = -30.0 * kDegree,
                        .azimuth_max_rad = 30.0 * kDegree,
                        .elevation_min_rad = -20.0 * kDegree,
                        .elevation_max_rad = 20.0 * kDegree,
                        .least_ahead = 0.5,
                        .spacing_rad = kDegree};
  }

  void make_hole(int i) {
    for (const int step : {-1, 0, 1}) map.set_label({i + step, 19, 6}, Label::Occluded);
  }

  // From the positions offered, x fastest.
  std::vector<HoleView> views_from(const std::vector<VoxelIndex>& positions) {
    const ClearSpace clear(map, {.clearance_m = 0.15, .body_radius_m = 0.05});
    ShortestPaths paths;
    paths.find(clear, map, map.grid().center_m({10, 3, 6}), 0.3);
    holes = surface_holes(map, 10);
    return hole_views(FreeSpaceField(map), 0.1, holes, paths, positions, parameters);
  }

  VoxelMap map;
  std::vector<SurfaceHole> holes;
  HoleViewParameters parameters;
};

TEST_F(RoomWithHoles, AViewIsAimedAtTheMiddleOfAHole) {
  make_hole(10);
  const auto views = views_from({{10, 5, 6}});
  ASSERT_EQ(views.size(), 1u);
  EXPECT_EQ(views[0].hole, 0u);
  EXPECT_EQ(views[0].voxel, VoxelIndex(10, 5, 6));
  EXPECT_NEAR(views[0].pan_rad, 0.0, 1e-12);
  EXPECT_NEAR(views[0].tilt_rad, 0.0, 1e-12);
  EXPECT_EQ(views[0].in_sight.size(), 3u);
  EXPECT_NEAR(views[0].gain_voxels, 3.0, 1e-12);
  EXPECT_NEAR(views[0].path_m, 0.2, 1e-9);
  EXPECT_NEAR(views[0].score, 3.0 * std::exp(-0.12 * 0.2), 1e-9);
}

TEST_F(RoomWithHoles, PanAndTiltTurnTheRightWay) {
  map.set_label({16, 19, 6}, Label::Unmarked);  // 6 to the right, 8 ahead, and 2 below
  const auto views = views_from({{10, 11, 8}});
  ASSERT_EQ(views.size(), 1u);
  const Eigen::Vector3d towards = Eigen::Vector3d(6.0, 8.0, -2.0).normalized();
  EXPECT_NEAR((viewing_direction(views[0].pan_rad, views[0].tilt_rad) - towards).norm(), 0.0,
              1e-12);
}

// A pillar from floor to ceiling hides the hole from where the robot is; from beside it the hole is
// in sight.
TEST_F(RoomWithHoles, NothingIsSeenThroughWhatIsOccupied) {
  make_hole(10);
  for (int i = 7; i <= 13; ++i) {
    for (int k = 1; k < 11; ++k) map.set_label({i, 12, k}, Label::Occupied);
  }
  EXPECT_TRUE(views_from({{10, 5, 6}, {9, 4, 3}}).empty());
  const auto views = views_from({{10, 5, 6}, {3, 14, 6}, {9, 4, 3}});
  ASSERT_EQ(views.size(), 1u);
  EXPECT_EQ(views[0].voxel, VoxelIndex(3, 14, 6));
}

TEST_F(RoomWithHoles, NothingIsSeenThroughWhatIsUnknown) {
  make_hole(10);
  for (int i = 1; i < 20; ++i) {
    for (int k = 1; k < 11; ++k) map.set_label({i, 12, k}, Label::Occluded);
  }
  const auto views = views_from({{10, 5, 6}});
  ASSERT_FALSE(views.empty());
  for (const HoleView& view : views) {
    for (const HoleVoxel* voxel : view.in_sight) EXPECT_EQ(voxel->voxel[1], 12);
  }
}

TEST_F(RoomWithHoles, FlatAnglesAndRangesBeyondTheSensorsDoNotCount) {
  map.set_label({14, 19, 6}, Label::Unmarked);
  parameters.min_cosine = 0.55;
  EXPECT_TRUE(views_from({{9, 16, 6}}).empty());    // 3 / sqrt(34) = 0.51
  EXPECT_EQ(views_from({{10, 16, 6}}).size(), 1u);  // 3 / 5
  parameters.min_cosine = 0.5;
  EXPECT_EQ(views_from({{9, 16, 6}}).size(), 1u);
  parameters.range_max_m = 1.05;
  EXPECT_TRUE(views_from({{14, 8, 6}}).empty());  // 1.1 m
  EXPECT_EQ(views_from({{14, 9, 6}}).size(), 1u);
  parameters.range_min_m = 0.45;
  EXPECT_EQ(views_from({{14, 14, 6}}).size(), 1u);
  EXPECT_TRUE(views_from({{14, 15, 6}}).empty());  // 0.4 m
}

TEST_F(RoomWithHoles, OfEqualViewsTheNearestIsTaken) {
  make_hole(10);
  const auto views = views_from({{14, 9, 6}, {10, 5, 6}, {6, 9, 6}});
  ASSERT_EQ(views.size(), 1u);
  EXPECT_EQ(views[0].voxel, VoxelIndex(10, 5, 6));
}

TEST_F(RoomWithHoles, WhereNoPathLeadsNobodyLooksFrom) {
  make_hole(10);
  EXPECT_TRUE(views_from({{10, 18, 6}}).empty());  // too near to the wall
}

// Two holes lie in one view from far away; near the first the other is 63 degrees to the right.
TEST_F(RoomWithHoles, AViewOfTwoHolesIsBetterThanOfOne) {
  make_hole(7);
  make_hole(13);
  const auto far = views_from({{10, 5, 6}});
  ASSERT_EQ(far.size(), 2u);
  EXPECT_EQ(far[0].in_sight.size(), 6u);
  EXPECT_NEAR(far[0].gain_voxels, 6.0, 1e-12);
  const auto near = views_from({{7, 16, 6}});
  ASSERT_EQ(near.size(), 2u);
  EXPECT_EQ(near[0].in_sight.size(), 3u);
}

TEST_F(RoomWithHoles, TheMostRewardingHoleComesFirst) {
  map.set_label({3, 19, 6}, Label::Unmarked);
  make_hole(17);
  const auto views = views_from({{3, 15, 6}, {17, 15, 6}});
  ASSERT_EQ(views.size(), 2u);
  EXPECT_EQ(views[0].hole, 1u);
  EXPECT_EQ(views[0].voxel, VoxelIndex(17, 15, 6));
  EXPECT_EQ(views[1].voxel, VoxelIndex(3, 15, 6));
}

// 1.4 m away, rays 0.1 rad apart are 0.14 m apart: each hits one of 1.4 x 1.4 voxels.
TEST_F(RoomWithHoles, SparseRaysAndDistrustCountLess) {
  map.set_label({10, 19, 6}, Label::Unmarked);
  parameters.field.spacing_rad = 0.1;
  const auto views = views_from({{10, 5, 6}});
  ASSERT_EQ(views.size(), 1u);
  EXPECT_NEAR(views[0].gain_voxels, 1.0 / 1.96, 1e-12);
  const ClearSpace clear(map, {.clearance_m = 0.15, .body_radius_m = 0.05});
  ShortestPaths paths;
  paths.find(clear, map, map.grid().center_m({10, 3, 6}), 0.3);
  holes[0].voxels[0].trust = 0.25;
  const std::vector<VoxelIndex> positions = {{10, 5, 6}};
  EXPECT_NEAR(
      hole_views(FreeSpaceField(map), 0.1, holes, paths, positions, parameters)[0].gain_voxels,
      0.25 / 1.96, 1e-12);
}

// Every voxel of every hole, one after the other.
TEST_F(RoomWithHoles, AViewShowsOfAllHolesWhatAskingForEveryVoxelSays) {
  std::mt19937 random(7);
  int shown = 0;
  int not_shown = 0;
  parameters.range_max_m = 1.6;
  for (int world = 0; world < 40; ++world) {
    for_each_voxel(map.window(), [&](const VoxelIndex& v) {
      const bool wall = (v.array() == 0).any() || v[0] == 20 || v[1] == 19 || v[2] == 11;
      const bool is_hole = random() % (wall ? 4 : 400) == 0;
      map.set_label(v, is_hole ? Label::Unmarked : wall ? Label::Occupied : Label::Empty);
    });
    const FreeSpaceField field(map);
    for (const HoleView& view : views_from({{10, 4, 6}, {10, 3, 6}, {8, 3, 5}, {10, 5, 7}})) {
      const Eigen::Matrix3d sensor_from_world =
          world_from_sensor_rotation(view.pan_rad, view.tilt_rad).transpose();
      std::vector<VoxelIndex> expected;
      for (const SurfaceHole& hole : holes) {
        for (const HoleVoxel& voxel : hole.voxels) {
          const Eigen::Vector3d out = 0.1 * (view.voxel - voxel.voxel).cast<double>();
          const bool in_range = out.norm() <= parameters.range_max_m;
          const bool flat = !voxel.outward.isZero() &&
                            out.dot(voxel.outward) < parameters.min_cosine * out.norm();
          const bool in_field = parameters.field.contains(sensor_from_world * -out.normalized());
          if (in_range && !flat && in_field && is_in_sight(field, view.voxel, voxel.voxel)) {
            expected.push_back(voxel.voxel);
          } else {
            ++not_shown;
          }
        }
      }
      std::vector<VoxelIndex> in_sight;
      for (const HoleVoxel* voxel : view.in_sight) in_sight.push_back(voxel->voxel);
      ASSERT_EQ(in_sight, expected);
      shown += static_cast<int>(expected.size());
    }
  }
  EXPECT_GT(shown, 1000);
  EXPECT_GT(not_shown, 1000);
}

TEST_F(RoomWithHoles, ParametersThatCannotBeAreNamed) {
  const auto refused = [&](auto change) {
    HoleViewParameters changed = parameters;
    change(changed);
    EXPECT_THROW(changed.check(), std::invalid_argument);
  };
  parameters.check();
  refused([](HoleViewParameters& p) { p.range_max_m = 0.0; });
  refused([](HoleViewParameters& p) { p.range_min_m = -1.0; });
  refused([](HoleViewParameters& p) { p.min_cosine = 1.0; });
  refused([](HoleViewParameters& p) { p.path_cost_per_m = -1.0; });
  refused([](HoleViewParameters& p) { p.field = {}; });
}

// The line voxel by voxel.
bool is_in_sight_plainly(const VoxelMap& map, const VoxelIndex& from, const VoxelIndex& to) {
  const IntegerLine line = line_between(from, to);
  for (int k = 1; k < line.steps; ++k) {
    if (map.label(line.at(k)) != Label::Empty) return false;
  }
  return true;
}

TEST(Sight, IsThatOfThePlainLineInRandomWorlds) {
  std::mt19937 random(1);
  int clear = 0;
  int blocked = 0;
  for (int world = 0; world < 50; ++world) {
    VoxelMap map({0.1, Eigen::Vector3d::Zero()}, {VoxelIndex(-3, 2, 5), VoxelIndex(25, 20, 15)});
    for_each_voxel(map.window(), [&](const VoxelIndex& v) {
      map.set_label(v, random() % 60 == 0 ? static_cast<Label>(random() % 5) : Label::Empty);
    });
    const FreeSpaceField field(map);
    const auto any = [&] {
      VoxelIndex voxel = map.window().min;
      for (int axis = 0; axis < 3; ++axis) {
        voxel[axis] += static_cast<int>(random() % static_cast<unsigned>(map.window().size[axis]));
      }
      return voxel;
    };
    for (int line = 0; line < 400; ++line) {
      const VoxelIndex from = any();
      const VoxelIndex to = any();
      const bool expected = is_in_sight_plainly(map, from, to);
      ASSERT_EQ(is_in_sight(field, from, to), expected);
      ++(expected ? clear : blocked);
    }
  }
  EXPECT_GT(clear, 2000);
  EXPECT_GT(blocked, 2000);
}

TEST(FieldOfViewOf, ATiltedLineScanIsItsApertures) {
  const TiltedLineScan sensor = TiltedLineScan::paper();
  const FieldOfView field = field_of_view(make_ray_table(sensor));
  // The corners: tan(azimuth) = tan 30 / cos 19.535.
  EXPECT_NEAR(field.azimuth_max_rad, 31.49 * kDegree, 1e-4);
  EXPECT_NEAR(field.azimuth_min_rad, -31.49 * kDegree, 1e-4);
  EXPECT_NEAR(field.elevation_max_rad, 0.5 * 39.07 * kDegree, 1e-4);
  // 29 steps from row to row, 63 from column to column.
  EXPECT_NEAR(field.spacing_rad, 39.07 / 29.0 * kDegree, 1e-4);
  EXPECT_TRUE(field.contains(Eigen::Vector3d::UnitY()));
  EXPECT_TRUE(field.contains(Eigen::Vector3d(1.0, 2.0, 0.0).normalized()));    // 27 degrees
  EXPECT_FALSE(field.contains(Eigen::Vector3d(2.0, 3.0, 0.0).normalized()));   // 34
  EXPECT_FALSE(field.contains(Eigen::Vector3d(0.0, 2.0, -1.0).normalized()));  // 27 down
  EXPECT_FALSE(field.contains(-Eigen::Vector3d::UnitY()));
}

TEST(FieldOfViewOf, EverySensorHoldsItsOwnRays) {
  const std::vector<SensorGeometry> sensors = {TiltedLineScan::with_aperture(16, 9, 1.2),
                                               SphericalScanner{}, LineStriper{}};
  for (const SensorGeometry& sensor : sensors) {
    const RayTable rays = make_ray_table(with_raster(sensor, 24, 12));
    const FieldOfView field = field_of_view(rays);
    for (int v = 0; v < rays.rows(); ++v) {
      for (int u = 0; u < rays.columns(); ++u) EXPECT_TRUE(field.contains(rays.ray(u, v)));
    }
  }
}

}  // namespace
}  // namespace nextview
