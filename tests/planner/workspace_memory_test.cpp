// What planning keeps for every voxel of the workspace takes memory for what has been seen of it.
#include <gtest/gtest.h>

#include <iostream>
#include <numbers>
#include <string>

#include "mapper/map_builder.h"
#include "planner/prediction/grown_surface.h"
#include "planner/prediction/known_space.h"
#include "planner/shortest_paths.h"
#include "tests/mapper/analytic_world.h"

namespace nextview {
namespace {

struct Taken {
  std::size_t bytes = 0;
  std::size_t positions = 0;  // that a path leads to
  std::string digest;
};

// After one look around from the middle, in which nothing is hit: what is hidden would reach to the
// limit of the workspace, and so be another in each.
Taken taken_in(int half_side) {
  const VoxelGrid grid{0.1, Eigen::Vector3d::Zero()};
  const VoxelIndex half(half_side, half_side, 50);
  MapBuilder builder(grid, {-half, 2 * half});
  KnownSpace space(builder.map());
  const FoldReport& report = builder.fold(scan_world(
      AnalyticWorld(), make_ray_table(SphericalScanner{128, 64, 2 * std::numbers::pi, 1.7}),
      {0.05, 4.0}, SensorPose()));
  space.update(report.changed_slots, report.updated_surfaces);
  const FeasibilityParameters parameters;
  const ClearSpace clear(builder.map(), parameters);
  ShortestPaths paths;
  for (int time = 0; time < 2; ++time) {
    paths.find(clear, builder.map(), Eigen::Vector3d::Zero(), parameters.departure_m);
  }
  return {builder.memory_bytes() + space.field().memory_bytes() + clear.memory_bytes() +
              paths.memory_bytes(),
          paths.reached().size(), builder.digest()};
}

TEST(WorkspaceMemory, IsOfWhatWasSeen) {
  const Taken in_20_m = taken_in(100);
  const Taken in_200_m = taken_in(1000);
  std::cout << in_20_m.bytes / 1000 << " kB in 20 m x 20 m x 10 m, " << in_200_m.bytes / 1000
            << " kB in 200 m x 200 m x 10 m; " << in_20_m.positions << " positions\n";
  EXPECT_EQ(in_200_m.digest, in_20_m.digest);
  EXPECT_EQ(in_200_m.positions, in_20_m.positions);
  EXPECT_GT(in_20_m.positions, 1000u);
  // A hundred times the workspace: filled it would be 6 GB.
  EXPECT_LT(in_200_m.bytes, std::size_t{150} << 20);
}

// What grows from floor and ceiling into the unknown, after one look around between them.
struct Grown {
  std::size_t bytes = 0;
  std::size_t voxels = 0;
};
Grown grown_in(int half_side) {
  const VoxelIndex half(half_side, half_side, 50);
  MapBuilder builder({0.1, Eigen::Vector3d::Zero()}, {-half, 2 * half});
  AnalyticWorld world;
  world.planes = {{Eigen::Vector3d::UnitZ(), -1.2}, {Eigen::Vector3d::UnitZ(), 1.2}};
  builder.fold(scan_world(world,
                          make_ray_table(SphericalScanner{128, 64, 2 * std::numbers::pi, 1.7}),
                          {0.05, 4.0}, SensorPose()));
  const GrownSurface grown(builder.map());
  return {grown.memory_bytes(), grown.size()};
}

TEST(WorkspaceMemory, OfWhatIsExpectedBehindTheUnknownIsOfWhatWasSeen) {
  const Grown in_20_m = grown_in(100);
  const Grown in_200_m = grown_in(1000);
  std::cout << in_20_m.bytes / 1000 << " kB in 20 m x 20 m x 10 m, " << in_200_m.bytes / 1000
            << " kB in 200 m x 200 m x 10 m; " << in_20_m.voxels << " voxels grown\n";
  EXPECT_EQ(in_200_m.voxels, in_20_m.voxels);
  EXPECT_GT(in_20_m.voxels, 1000u);
  // Filled it would be 6 GB.
  EXPECT_LT(in_200_m.bytes, std::size_t{150} << 20);
}

}  // namespace
}  // namespace nextview
