// Rooms scanned from all over, folded with a window far smaller than they are: the digests of one
// buffer over all (P10).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <numbers>
#include <vector>

#include "mapper/map_builder.h"
#include "mapper/paged_map_builder.h"
#include "scene/scene.h"
#include "scene/scene_catalog.h"
#include "sensor_sim/scan.h"
#include "tests/scene/test_worlds.h"

namespace nextview {
namespace {

struct Room {
  explicit Room(const std::string& name)
      : description(find_scene(name, kScenesFolder.string())),
        scene(load_mesh(description.file, description.options)) {
    const auto voxel = [&](const auto& corner_m) {
      return grid.voxel_of(Eigen::Vector3d(corner_m.template cast<double>()));
    };
    extent.min = voxel(scene.mesh().bounds_m().min()) - VoxelIndex::Ones();
    extent.size = voxel(scene.mesh().bounds_m().max()) + VoxelIndex::Constant(2) - extent.min;
  }

  // From places in the room about its start, farther and farther away, and back.
  std::vector<SensorPose> poses(int count, const Eigen::Vector3d& reach_m) const {
    std::vector<SensorPose> poses;
    for (int n = 0; n < count; ++n) {
      const double away = std::sin(std::numbers::pi * n / (count - 1));
      SensorPose pose;
      pose.position_m = description.start_m.value() + away * reach_m;
      pose.pan_rad = 2.4 * n;
      pose.tilt_rad = 0.5 * (n % 3 - 1);
      poses.push_back(pose);
    }
    return poses;
  }

  SceneDescription description;
  Scene scene;
  VoxelGrid grid = {0.1, Eigen::Vector3d::Zero()};
  MapWindow extent;
};

// Folds the scans of all poses into both, and compares after each. The window must have moved, and
// at the end be smaller than the extent.
void expect_one_map(const Room& room, const VoxelIndex& window,
                    const std::vector<SensorPose>& poses, const RayTable& rays) {
  PagedMapBuilder paged(room.grid, room.extent, window);
  MapBuilder builder(room.grid, room.extent);
  int moves = 0;
  std::size_t most_bytes = 0;
  for (const SensorPose& pose : poses) {
    RandomStream noise = random_stream(1);
    const RangeImage image = scan(room.scene, rays, RangeLimits(), pose, 0.0, noise);
    const VoxelIndex before = paged.window().min;
    paged.fold(image);
    builder.fold(image);
    moves += paged.window().min != before;
    ASSERT_EQ(paged.digest(), builder.digest());
    ASSERT_EQ(paged.statistics().voxels, builder.statistics().voxels);
    ASSERT_EQ(paged.statistics().occupied_faces, builder.statistics().occupied_faces);
    ASSERT_EQ(paged.statistics().mean_quality, builder.statistics().mean_quality);
    most_bytes = std::max(most_bytes, paged.memory_bytes());
  }
  const MapStatistics statistics = builder.statistics();
  const auto all = room.extent.size.cast<std::int64_t>().prod();
  EXPECT_GT(moves, 1);
  EXPECT_LT(paged.window().size.cast<std::int64_t>().prod(), all);
  EXPECT_GT(statistics.voxels[static_cast<std::size_t>(Label::Occupied)], 500);
  const std::int64_t seen = all - statistics.voxels[static_cast<std::size_t>(Label::Unmarked)];
  std::cout << room.description.name << ": window " << paged.window().size.transpose() << " of "
            << room.extent.size.transpose() << " voxels, " << poses.size() << " views, "
            << paged.blocks_aside() << " blocks aside, " << most_bytes / 1000 << " KB at most, "
            << static_cast<double>(most_bytes) / static_cast<double>(seen)
            << " bytes a voxel seen; one buffer " << builder.memory_bytes() / 1000 << " KB\n";
}

TEST(PagedRooms, BoxesIsTheMapOfOneBuffer) {
  const Room room("boxes");
  expect_one_map(room, {16, 16, 16}, room.poses(20, {3.4, 0.9, 0.3}),
                 make_ray_table(TiltedLineScan::paper()));
}

TEST(PagedRooms, ColumnsIsTheMapOfOneBuffer) {
  const Room room("columns");
  expect_one_map(room, {16, 16, 16}, room.poses(20, {4.0, -2.0, 0.3}),
                 make_ray_table(TiltedLineScan::paper()));
}

TEST(PagedRooms, OfficeIsTheMapOfOneBuffer) {
  const auto folder = kSharedScenesFolder / "cpr_office";
  if (!std::filesystem::exists(folder)) {
    GTEST_SKIP() << folder << " is not here: a window in a real building was NOT tested";
  }
  const Room room(folder.string());
  expect_one_map(room, {64, 64, 32}, room.poses(12, {10.0, 1.0, 0.0}),
                 make_ray_table(SphericalScanner{256, 72, 2.0 * std::numbers::pi, 1.745}));
}

}  // namespace
}  // namespace nextview
