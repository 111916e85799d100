// The map update on worlds small enough to work out by hand, and what must not matter to it.
#include "mapper/map_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <numeric>

#include "mapper/map_digest.h"
#include "tests/mapper/analytic_world.h"

namespace nextview {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// Voxels of 1 m, voxel i centred on i metres.
VoxelGrid metre_grid() { return {1.0, Eigen::Vector3d::Zero()}; }

// Four pixels that all look along +y, from the centre of voxel (0, 0, 0).
RangeImage looking_along_y(const std::vector<float>& range_m) {
  RangeImage image;
  image.rays.column_sin = {0.0, 0.0};
  image.rays.column_cos = {1.0, 1.0};
  image.rays.row_sin = {0.0, 0.0};
  image.rays.row_cos = {1.0, 1.0};
  image.limits = {0.0, 6.0};
  image.range_m = range_m;
  return image;
}

std::string along_y(const VoxelMap& map, int i, int k) {
  std::string text;
  for (int j = map.window().min[1]; j < map.window().min[1] + map.window().size[1]; ++j) {
    text += "u#pEO"[static_cast<int>(map.label({i, j, k}))];
  }
  return text;
}

TEST(MapBuilder, MarksARayByHand) {
  MapBuilder builder(metre_grid(), {{-1, -1, -1}, {3, 8, 3}});
  const FoldReport& report = builder.fold(looking_along_y({3.0f, 3.0f, 3.0f, 3.0f}));
  // The sensor in y = 0, its ray Empty up to the point in y = 3, hidden up to the limit y = 6.
  // The first hidden voxel touches Occupied and Unmarked ones only, so it is no plane.
  EXPECT_EQ(along_y(builder.map(), 0, 0), "uEEEO###");
  EXPECT_EQ(report.points, 4);
  EXPECT_EQ(report.newly_occupied, 1);
  EXPECT_EQ(report.changed_slots.size(), 7u);
  const MapStatistics statistics = builder.statistics();
  EXPECT_EQ(statistics.voxels, (std::array<std::int64_t, kLabelCount>{72 - 7, 3, 0, 3, 1}));
  EXPECT_EQ(statistics.occupied_faces, 1);
  EXPECT_EQ(statistics.occupied_area_m2, 1.0);
  EXPECT_EQ(statistics.occlusion_plane_faces, 0);
}

TEST(MapBuilder, NearerMissNeverErasesAndFartherHitOpensWhatWasHidden) {
  MapBuilder builder(metre_grid(), {{-1, -1, -1}, {3, 8, 3}});
  builder.fold(looking_along_y({3.0f, 3.0f, 3.0f, 3.0f}));
  builder.fold(looking_along_y({5.0f, 5.0f, 5.0f, 5.0f}));
  EXPECT_EQ(along_y(builder.map(), 0, 0), "uEEEOEO#");
  builder.fold(looking_along_y({1.0f, 1.0f, 1.0f, 1.0f}));
  EXPECT_EQ(along_y(builder.map(), 0, 0), "uEOEOEO#");
}

TEST(MapBuilder, OcclusionPlaneComesAndGoes) {
  // A second line of sight passes beside the hidden voxels: from (1, 0, 0), along +y, without
  // return, so the hidden voxels of the first line gain an Empty neighbour each.
  MapBuilder builder(metre_grid(), {{-1, -1, -1}, {4, 8, 3}});
  builder.fold(looking_along_y({3.0f, 3.0f, 3.0f, 3.0f}));
  RangeImage beside = looking_along_y({kInf, kInf, kInf, kInf});
  beside.position_m = {1.0, 0.0, 0.0};
  beside.limits.max_m = 5.0;
  EXPECT_EQ(builder.fold(beside).no_returns, 4);
  EXPECT_EQ(along_y(builder.map(), 1, 0), "uEEEEEEu");
  EXPECT_EQ(along_y(builder.map(), 0, 0), "uEEEOpp#");
  EXPECT_EQ(builder.statistics().occlusion_plane_faces, 2);
  EXPECT_EQ(builder.statistics().occupied_faces, 2);

  // Something now stands in the Empty voxel beside y = 4: that face is one no longer.
  RangeImage hit = looking_along_y({4.0f, 4.0f, 4.0f, 4.0f});
  hit.position_m = {1.0, 0.0, 0.0};
  const FoldReport& report = builder.fold(hit);
  EXPECT_EQ(along_y(builder.map(), 1, 0), "uEEEEOEp");
  EXPECT_EQ(along_y(builder.map(), 0, 0), "uEEEO#p#");
  EXPECT_EQ(report.changed_slots.size(), 3u);  // Empty to Occupied, Unmarked to plane, plane to not
  EXPECT_EQ(builder.statistics().occlusion_plane_faces, 2);
}

TEST(MapBuilder, WhatLiesOutsideTheWindowIsNotEmpty) {
  // The sides of the buffer equal the window's, so its two ends are neighbours in memory.
  MapBuilder builder(metre_grid(), {{0, 0, 0}, {1, 8, 1}});
  builder.fold(looking_along_y({3.0f, 3.0f, 3.0f, 3.0f}));
  EXPECT_EQ(along_y(builder.map(), 0, 0), "EEEO####");
}

TEST(MapBuilder, NoReturnIsFreeUpToTheLargestRangeAndInvalidSaysNothing) {
  MapBuilder builder(metre_grid(), {{-1, -1, -1}, {3, 8, 3}});
  const FoldReport& report = builder.fold(looking_along_y({kNaN, kNaN, kNaN, kNaN}));
  EXPECT_EQ(report.invalid, 4);
  EXPECT_TRUE(report.changed_slots.empty());
  EXPECT_EQ(builder.digest(), MapBuilder(metre_grid(), MapWindow()).digest());
  RangeImage image = looking_along_y({kInf, kNaN, kInf, kInf});
  image.limits.max_m = 3.0;
  builder.fold(image);
  EXPECT_EQ(along_y(builder.map(), 0, 0), "uEEEEuuu");
}

TEST(MapBuilder, RangeBeyondTheLargestIsNoReturn) {
  MapBuilder builder(metre_grid(), {{-1, -1, -1}, {3, 8, 3}});
  RangeImage image = looking_along_y({3.0001f, 5.0f, 3e38f, 100.0f});
  image.limits = {0.5, 3.0};
  const FoldReport& report = builder.fold(image);
  EXPECT_EQ(report.no_returns, 4);
  EXPECT_EQ(report.points, 0);
  EXPECT_EQ(along_y(builder.map(), 0, 0), "uEEEEuuu");
}

TEST(MapBuilder, RangeBelowTheSmallestIsInvalid) {
  MapBuilder builder(metre_grid(), {{-1, -1, -1}, {3, 8, 3}});
  RangeImage image = looking_along_y({0.0f, -0.0f, 0.4999f, 0.1f});
  image.limits = {0.5, 3.0};
  const FoldReport& report = builder.fold(image);
  EXPECT_EQ(report.invalid, 4);
  EXPECT_EQ(report.points, 0);
  EXPECT_TRUE(report.changed_slots.empty());
  EXPECT_EQ(along_y(builder.map(), 0, 0), "uuuuuuuu") << "the sensor's own voxel above all";
}

TEST(MapBuilder, RangeAtALimitIsAPoint) {
  // 0.7 m is a little more than 0.7f, and 2.3 m a little less than 2.3f.
  MapBuilder builder(metre_grid(), {{-1, -1, -1}, {3, 8, 3}});
  RangeImage image = looking_along_y({0.7f, 0.7f, 2.3f, 2.3f});
  image.limits = {0.7, 2.3};
  EXPECT_EQ(builder.fold(image).points, 4);
  EXPECT_EQ(along_y(builder.map(), 0, 0), "uEOO####");
}

TEST(MapBuilder, PointOutsideTheWindowFreesTheWayToIt) {
  MapBuilder builder(metre_grid(), {{-1, -1, -1}, {3, 8, 3}});
  RangeImage image = looking_along_y({7.0f, 1e30f, 3e38f, 7.4f});
  image.limits.max_m = 3.2e38;
  const FoldReport& report = builder.fold(image);
  EXPECT_EQ(report.points_outside, 4);
  EXPECT_EQ(report.points, 0);
  EXPECT_EQ(along_y(builder.map(), 0, 0), "uEEEEEEE");
}

TEST(MapBuilder, PointInTheSensorsOwnVoxelHidesWhatLiesBeyond) {
  MapBuilder builder(metre_grid(), {{-1, -1, -1}, {3, 8, 3}});
  builder.fold(looking_along_y({0.0f, 0.3f, 0.4f, 0.1f}));
  EXPECT_EQ(along_y(builder.map(), 0, 0), "uO######");
}

// Two rays that end in one voxel and part behind it. Seen from (0, 0, 0) the point lies at (0, 2);
// straight on, the ray leaves through y = 6 at x = 0; turned by atan(1/5) to the right, through y
// = 6.5 at x = 1.3. The line from (0, 2) to (1, 6): x = 0 for one step and 1 from the half on.
TEST(MapBuilder, RaysThatMeetInAVoxelHideALineEach) {
  RangeImage image = looking_along_y({2.0f, 2.0f, 2.0f, 2.0f});
  const double length = std::sqrt(26.0);
  image.rays.column_sin = {0.0, -1.0 / length};
  image.rays.column_cos = {1.0, 5.0 / length};
  MapBuilder builder(metre_grid(), {{-1, -1, -1}, {3, 8, 3}});
  EXPECT_EQ(builder.fold(image).points, 4);
  EXPECT_EQ(along_y(builder.map(), 0, 0), "uEEO####");
  EXPECT_EQ(along_y(builder.map(), 1, 0), "uuuuu###");
  EXPECT_EQ(along_y(builder.map(), -1, 0), "uuuuuuuu");
  EXPECT_EQ(builder.statistics().voxels,
            (std::array<std::int64_t, kLabelCount>{72 - 10, 7, 0, 2, 1}));
}

TEST(MapBuilder, HitsBeatMissesWithinAnImage) {
  MapBuilder builder(metre_grid(), {{-1, -1, -1}, {3, 8, 3}});
  builder.fold(looking_along_y({2.0f, 5.0f, kInf, 3.0f}));
  EXPECT_EQ(along_y(builder.map(), 0, 0), "uEEOOEOE");
}

TEST(MapBuilder, KeepsTheBestQualityAndTheSumOfNormals) {
  // A wall across the optical axis, y = 2 m, seen twice: aslant, then head-on.
  AnalyticWorld world;
  world.planes.push_back({Eigen::Vector3d(0, 1, 0), 2.0});
  const RayTable rays = make_ray_table(TiltedLineScan::paper());
  const VoxelGrid grid = {0.1, Eigen::Vector3d::Zero()};
  MapBuilder builder(grid, {{-20, -20, -20}, {64, 64, 40}});
  SensorPose aslant;
  aslant.position_m = {2.0, 0.0, 0.0};
  aslant.pan_rad = std::numbers::pi / 4;
  builder.fold(scan_world(world, rays, RangeLimits(), aslant));
  const VoxelIndex ahead(0, 20, 0);
  ASSERT_NE(builder.map().surface(ahead), nullptr);
  EXPECT_NEAR(builder.map().surface(ahead)->quality_01(), std::sqrt(0.5), 0.03);
  const std::uint32_t first_count = builder.map().surface(ahead)->normal_count;
  builder.fold(scan_world(world, rays, RangeLimits(), SensorPose()));
  EXPECT_GT(builder.map().surface(ahead)->quality_01(), 0.99);
  EXPECT_GT(builder.map().surface(ahead)->normal_count, first_count);
  EXPECT_GT(builder.map().surface(ahead)->mean_normal().dot(Eigen::Vector3d(0, -1, 0)), 0.9998);
}

TEST(MapBuilder, ImagesThatCannotBeRightLeaveTheMapAlone) {
  MapBuilder builder(metre_grid(), {{-1, -1, -1}, {3, 8, 3}});
  const RangeImage good = looking_along_y({3.0f, 3.0f, 3.0f, 3.0f});
  builder.fold(good);
  const std::string digest = builder.digest();
  std::vector<RangeImage> bad(13, good);
  bad[0].range_m.pop_back();
  bad[1].range_m[2] = -1.0f;
  bad[2].range_m[2] = -kInf;
  bad[3].position_m = {0.0, 100.0, 0.0};
  bad[4].position_m[1] = kNaN;
  bad[5].position_m[1] = 1e300;
  bad[6].world_from_sensor(0, 0) = 2.0;
  bad[7].world_from_sensor(0, 0) = kNaN;
  bad[8].rays.row_sin[0] = 0.5;
  bad[9].limits.max_m = kInf;
  bad[10].rays.column_cos.pop_back();
  bad[11].world_from_sensor(0, 0) = -1.0;  // a mirror
  bad[12].world_from_sensor(0, 0) = 1.0001;
  for (const RangeImage& image : bad) EXPECT_THROW(builder.fold(image), std::invalid_argument);
  EXPECT_EQ(builder.digest(), digest);
}

TEST(MapBuilder, SinesAndRotationsMayBeThoseOf32BitFloats) {
  RangeImage image = looking_along_y({3.0f, 3.0f, 3.0f, 3.0f});
  const Eigen::Matrix3d rotation = world_from_sensor_rotation(0.7, -0.4);
  image.world_from_sensor = rotation.cast<float>().cast<double>();
  for (std::size_t i = 0; i < 2; ++i) {
    image.rays.column_sin[i] = static_cast<double>(std::sin(0.3f));
    image.rays.column_cos[i] = static_cast<double>(std::cos(0.3f));
  }
  ASSERT_NE(image.world_from_sensor, rotation);
  MapBuilder builder(metre_grid(), {{-4, -4, -4}, {9, 9, 9}});
  EXPECT_EQ(builder.fold(image).points, 4);
}

struct Room {
  AnalyticWorld world;
  VoxelGrid grid = {0.1, Eigen::Vector3d::Zero()};
  MapWindow window = {{-4, -4, -2}, {64, 48, 32}};
  Room() {
    world.boxes.push_back({Eigen::Vector3d::Zero(), {5.0, 3.0, 3.0}});
    world.boxes.push_back({{3.0, 1.0, 0.0}, {3.5, 2.0, 1.2}});
    world.spheres.push_back({{1.0, 2.5, 0.5}, 0.4});
  }
  RangeImage view(double pan_rad, double tilt_rad) const {
    const SensorPose pose = {{1.5, 1.2, 1.4}, pan_rad, tilt_rad};
    return scan_world(world, make_ray_table(TiltedLineScan::paper()), {0.05, 4.0}, pose);
  }
};

TEST(MapBuilder, OrderOfPixelsDoesNotMatter) {
  const Room room;
  RandomStream random(5, 1, 1, RandomPurpose::RangeNoise);
  // Normals come from neighbours, which a permutation tears apart; so labels only.
  int images = 0;
  for (; images < 50; ++images) {
    const RangeImage image = room.view(uniform(random, -3.1, 3.1), uniform(random, -1.5, 1.5));
    const auto columns = static_cast<std::size_t>(image.rays.columns());
    std::vector<std::size_t> order(columns);
    std::iota(order.begin(), order.end(), 0u);
    for (std::size_t n = columns - 1; n > 0; --n) {
      std::swap(order[n], order[random.below(static_cast<std::uint32_t>(n + 1))]);
    }
    RangeImage shuffled = image;
    for (std::size_t u = 0; u < columns; ++u) {
      shuffled.rays.column_sin[u] = image.rays.column_sin[order[u]];
      shuffled.rays.column_cos[u] = image.rays.column_cos[order[u]];
      for (std::size_t v = 0; v < image.rays.row_sin.size(); ++v) {
        shuffled.range_m[v * columns + u] = image.range_m[v * columns + order[u]];
      }
    }
    MapBuilder a(room.grid, room.window);
    MapBuilder b(room.grid, room.window);
    a.fold(image);
    b.fold(shuffled);
    ASSERT_TRUE(std::ranges::equal(a.map().labels(), b.map().labels()));
    ASSERT_EQ(a.statistics().occlusion_plane_faces, b.statistics().occlusion_plane_faces);
  }
  EXPECT_EQ(images, 50);
}

TEST(MapBuilder, OrderOfImagesDoesNotMatter) {
  const Room room;
  MapBuilder a(room.grid, room.window);
  MapBuilder b(room.grid, room.window);
  const RangeImage images[] = {room.view(0.1, 0.0), room.view(2.0, -0.4), room.view(-1.5, 0.5)};
  for (const int n : {0, 1, 2}) a.fold(images[n]);
  for (const int n : {2, 0, 1}) b.fold(images[n]);
  EXPECT_EQ(a.digest(), b.digest());
}

TEST(MapBuilder, AWholeRoomOnThePapersMapTakesLessThanThreeMegabytes) {
  const Room room;
  MapBuilder builder(room.grid, room.window);
  for (int pan = 0; pan < 12; ++pan) {
    for (int tilt = -2; tilt <= 2; ++tilt) {
      builder.fold(room.view(pan * std::numbers::pi / 6, tilt * std::numbers::pi / 5));
    }
  }
  EXPECT_GT(builder.statistics().occupied_area_m2, 50.0);
  EXPECT_LT(builder.map().memory_bytes(), 3'000'000u);
  EXPECT_LT(builder.memory_bytes(), 3'000'000u);
  std::cout << "map " << builder.map().memory_bytes() << " bytes, with all that keeps it "
            << builder.memory_bytes() << '\n';
}

}  // namespace
}  // namespace nextview
