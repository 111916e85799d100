// A map whose window follows the sensor, against one that is large enough to hold everything.
#include <gtest/gtest.h>

#include <iostream>
#include <numbers>
#include <string>
#include <vector>

#include "mapper/map_builder.h"
#include "mapper/map_digest.h"
#include "tests/mapper/analytic_world.h"

namespace nextview {
namespace {

constexpr int kStep = 4;             // voxels the sensor goes on between two images
constexpr int kJourney = 400;        // voxels: 100 m
constexpr double kRangeMax_m = 4.0;  // 16 voxels
const VoxelIndex kSize(56, 60, 52);  // holds what is hidden behind the farthest point, and more
const VoxelIndex kBehind(-27, -30, -25);  // from the sensor to the window's first voxel

VoxelGrid quarter_metre_grid() { return {0.25, Eigen::Vector3d::Zero()}; }

bool is_hidden(Label label) { return label == Label::Occluded || label == Label::OcclusionPlane; }

// Of what has been seen in a window: Empty and Occupied voxels, with their surface data. What is
// hidden is left out, as a ray hides as much as the map has room for.
std::string digest_of_seen(const VoxelMap& map, const MapWindow& window) {
  VoxelMap seen(map.grid(), window);
  for_each_voxel(window, [&](const VoxelIndex& voxel) {
    const Label label = map.label(voxel);
    if (!is_hidden(label)) seen.set_label(voxel, label);
    const SurfaceVoxel* const surface = map.surface(voxel);
    if (surface != nullptr) seen.surface_at(voxel) = *surface;
  });
  return map_digest(seen);
}

// Whether a voxel or one of its neighbours is marked at all.
bool is_marked_nearby(const VoxelMap& map, const VoxelIndex& voxel) {
  bool marked = false;
  for_each_voxel({voxel - VoxelIndex::Ones(), VoxelIndex::Constant(3)},
                 [&](const VoxelIndex& near) { marked |= map.label(near) != Label::Unmarked; });
  return marked;
}

// A map that holds everything, and which of its voxels were first hidden while the moving window
// was elsewhere.
struct Everything {
  explicit Everything(const MapWindow& window)
      : builder(quarter_metre_grid(), window), hidden_elsewhere(builder.map().labels().size()) {}

  void fold(const RangeImage& image, const MapWindow& moving) {
    for (const std::uint32_t slot : builder.fold(image).changed_slots) {
      const VoxelMap& map = builder.map();
      if (is_hidden(map.labels()[slot]) && !moving.contains(map.index_of_slot(slot))) {
        hidden_elsewhere[slot] = true;
      }
    }
  }
  void expect_where_both_hold(const MapBuilder& moving) const {
    const VoxelMap& map = builder.map();
    const MapWindow& window = moving.map().window();
    ASSERT_EQ(digest_of_seen(moving.map(), window), digest_of_seen(map, window));
    // A ray has another limit in another window, and the line to it may pass a voxel farther left
    // or right; so what one map hides the other has marked too, or has marked beside it.
    int hidden = 0, different = 0, wrong = 0;
    for_each_voxel(window, [&](const VoxelIndex& voxel) {
      const bool here = is_hidden(moving.map().label(voxel));
      const bool there = is_hidden(map.label(voxel)) && !hidden_elsewhere[map.slot(voxel)];
      hidden += here;
      if (here && !is_hidden(map.label(voxel))) {
        ++different;
        wrong += !is_marked_nearby(map, voxel);
      } else if (there && !here) {
        ++different;
        wrong += !is_marked_nearby(moving.map(), voxel);
      }
    });
    ASSERT_EQ(wrong, 0);
    ASSERT_LT(different, hidden / 5);
  }

  MapBuilder builder;
  std::vector<bool> hidden_elsewhere;  // by slot
};

class MovingWindowAlong : public testing::TestWithParam<int> {};

TEST_P(MovingWindowAlong, FollowsASensorAHundredMetresAndBack) {
  const int axis = GetParam();
  const AnalyticWorld world = passage(axis);
  const RayTable rays = make_ray_table(TiltedLineScan::with_aperture(24, 18, 1.4));
  MapWindow whole{kBehind, kSize};
  whole.size[axis] += kJourney;
  MapBuilder moving(quarter_metre_grid(), {kBehind, kSize});
  Everything way_out(whole);
  Everything way_back(whole);

  int images = 0;
  std::int64_t reported_areas = 0;
  const auto scan_at = [&](int along, Everything& everything) {
    VoxelIndex sensor = VoxelIndex::Zero();
    sensor[axis] = along;
    SensorPose pose;
    pose.position_m = moving.map().grid().center_m(sensor);
    pose.pan_rad = 2.1 * images;
    pose.tilt_rad = 0.6 * (images % 5 - 2);
    const RangeImage image = scan_world(world, rays, {0.05, kRangeMax_m}, pose);
    moving.move_window(sensor + kBehind);
    moving.fold(image);
    everything.fold(image, moving.map().window());
    EXPECT_EQ(moving.digest(), map_digest(moving.map()));
    reported_areas += moving.statistics().occupied_faces;
    ++images;
  };

  for (int along = 0; along <= kJourney; along += kStep) {
    scan_at(along, way_out);
    ASSERT_NO_FATAL_FAILURE(way_out.expect_where_both_hold(moving)) << "at " << along;
  }
  // What enters again has been forgotten; and once everything from the way out has been left
  // behind, the map is one of the way back alone.
  std::int64_t forgotten = 0;
  std::int64_t remembered = 0;
  for (int along = kJourney - kStep; along >= 0; along -= kStep) {
    const MapWindow before = moving.map().window();
    scan_at(along, way_back);
    for_each_voxel(moving.map().window(), [&](const VoxelIndex& voxel) {
      if (before.contains(voxel) || way_out.builder.map().label(voxel) == Label::Unmarked) return;
      ++forgotten;
      const Label here = moving.map().label(voxel);
      const Label on_way_back = way_back.builder.map().label(voxel);
      remembered += here != on_way_back && !(is_hidden(here) || is_hidden(on_way_back));
    });
    if (along + kSize[axis] <= kJourney + kBehind[axis]) {
      ASSERT_NO_FATAL_FAILURE(way_back.expect_where_both_hold(moving)) << "back at " << along;
    }
  }
  EXPECT_EQ(images, 2 * kJourney / kStep + 1);
  EXPECT_GT(reported_areas, 0);
  EXPECT_GT(forgotten, 100'000);
  EXPECT_EQ(remembered, 0);
  EXPECT_GT(way_out.builder.statistics().voxels[static_cast<std::size_t>(Label::Occluded)], 10'000);
  std::cout << forgotten << " voxels entered again as if never seen; the moving map takes "
            << moving.memory_bytes() / 1000 << " KB, one that holds everything "
            << way_out.builder.memory_bytes() / 1000 << " KB\n";
}

INSTANTIATE_TEST_SUITE_P(EachAxis, MovingWindowAlong, testing::Values(0, 1, 2));

TEST(MovingWindow, TakesNoMoreMemoryTheFartherItGoes) {
  const AnalyticWorld world = passage(0);
  const RayTable rays = make_ray_table(TiltedLineScan::with_aperture(24, 18, 1.4));
  MapBuilder builder(quarter_metre_grid(), {kBehind, kSize});
  std::size_t after_first_half = 0;
  for (int along = 0; along <= kJourney; along += kStep) {
    SensorPose pose;
    pose.position_m = builder.map().grid().center_m({along, 0, 0});
    pose.pan_rad = 2.1 * along;
    builder.move_window(VoxelIndex(along, 0, 0) + kBehind);
    builder.fold(scan_world(world, rays, {0.05, kRangeMax_m}, pose));
    if (along == kJourney / 2) after_first_half = builder.memory_bytes();
  }
  EXPECT_LT(builder.memory_bytes(), after_first_half + after_first_half / 10);
}

TEST(MovingWindow, ForgetsEverythingWhenItJumpsAndStartsAgain) {
  const AnalyticWorld world = passage(0);
  const RayTable rays = make_ray_table(TiltedLineScan::paper());
  MapBuilder builder(quarter_metre_grid(), {kBehind, kSize});
  const RangeImage image = scan_world(world, rays, {0.05, kRangeMax_m}, SensorPose());
  builder.fold(image);
  const std::string digest = builder.digest();
  const MapStatistics statistics = builder.statistics();
  builder.move_window({100'003, -50'001, 7});
  EXPECT_EQ(builder.digest(), MapBuilder(quarter_metre_grid(), MapWindow()).digest());
  EXPECT_EQ(builder.statistics().voxels[0], kSize.prod());
  EXPECT_EQ(builder.statistics().occupied_faces, 0);
  EXPECT_EQ(builder.statistics().mean_quality, 0.0);
  builder.move_window(kBehind);
  builder.fold(image);
  EXPECT_EQ(builder.digest(), digest);
  EXPECT_EQ(builder.statistics().voxels, statistics.voxels);
  EXPECT_EQ(builder.statistics().mean_quality, statistics.mean_quality);
}

}  // namespace
}  // namespace nextview
