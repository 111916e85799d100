#include "scoring/pose_cover.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include "mapper/map_builder.h"
#include "scoring/lattice_path.h"
#include "scoring/view_bound.h"
#include "sensor_sim/scan.h"
#include "tests/scoring/room_mesh.h"

namespace nextview {
namespace {

namespace fs = std::filesystem;

const Eigen::Vector3d kSize(3.0, 2.0, 2.0);

TriangleMesh room_with_a_box() {
  TriangleMesh mesh = room(kSize);
  add_box(mesh, {2.0, 0.5, 0.0}, {2.5, 1.0, 0.8});
  return mesh;
}

VisibilityParameters visibility() {
  VisibilityParameters parameters;
  parameters.reach.box_max_m = kSize;
  return parameters;
}

TEST(PoseCover, IsWhatAMapHoldsAfterTheScan) {
  const Scene scene(room_with_a_box());
  const SensorPose start{{0.8, 0.9, 1.1}, -1.2, -0.2};
  PoseParameters parameters;
  parameters.subdivisions = 0;
  const VisibleSurface surface = visible_surface(scene, start.position_m, visibility());
  const std::vector<Eigen::Vector3d> reachable =
      reachable_positions(scene, start.position_m, visibility().reach);
  const PoseCover cover = cover_of_poses(scene, start, reachable, surface, parameters);
  ASSERT_EQ(cover.sets.poses(), cover.poses.size());
  ASSERT_EQ(cover.poses.size() % 20, 1u);
  EXPECT_EQ(cover.sets.total_weight(), static_cast<std::int64_t>(surface.points_m.size()));

  const RayTable rays = make_ray_table(parameters.sensor);
  std::set<std::size_t> looked_at = {0, 1, cover.poses.size() / 2, cover.poses.size() - 1};
  for (const std::size_t pose : looked_at) {
    RandomStream no_noise(0, 0, 0, RandomPurpose::RangeNoise);
    MapBuilder builder(parameters.grid, MapWindow{{-2, -2, -2}, {36, 26, 26}});
    builder.fold(scan(scene, rays, parameters.limits, cover.poses[pose], 0.0, no_noise));
    std::int64_t recovered = 0;
    for (const Eigen::Vector3f& point : surface.points_m) {
      const VoxelIndex voxel = parameters.grid.voxel_of(point.cast<double>());
      recovered += builder.map().label(voxel) == Label::Occupied ? 1 : 0;
    }
    std::int64_t covered = 0;
    for (const std::uint32_t voxel : cover.sets.covered_by(pose)) {
      covered += cover.sets.weights[voxel];
    }
    EXPECT_GT(recovered, 0);
    EXPECT_EQ(covered, recovered) << pose;
  }
}

TEST(PoseCover, RefusesASpacingThatCannotBe) {
  const Scene scene(room(kSize));
  PoseParameters parameters;
  parameters.spacing_m = 0.0;
  EXPECT_THROW(cover_of_poses(scene, SensorPose{}, {}, VisibleSurface{}, parameters),
               std::invalid_argument);
}

TEST(LatticePaths, GoRoundACorner) {
  // An L of one-metre steps: 4 along x, then 3 along y; one corner is cut diagonally.
  std::vector<Eigen::Vector3d> positions;
  for (int x = 0; x <= 4; ++x) positions.emplace_back(x, 0.0, 0.0);
  for (int y = 1; y <= 3; ++y) positions.emplace_back(4.0, y, 0.0);
  positions.emplace_back(9.0, 9.0, 9.0);
  const LatticePaths paths(positions, 1.0);
  EXPECT_NEAR(paths.length_m({0, 0, 0}, {4, 3, 0}), 3.0 + std::sqrt(2.0) + 2.0, 1e-12);
  EXPECT_NEAR(paths.length_m({0.0, 0.25, 0.0}, {2, 0, 0}), 2.25, 1e-12);
  EXPECT_EQ(paths.length_m({0, 0, 0}, {9, 9, 9}), std::numeric_limits<double>::infinity());
}

TEST(ViewBounds, AreInOrderAndAreKept) {
  const Scene scene(room_with_a_box());
  ViewBoundQuestion question;
  question.start = {{0.8, 0.9, 1.1}, 0.0, 0.0};
  question.visibility = visibility();
  question.poses.spacing_m = 0.5;
  question.poses.subdivisions = 0;
  question.shares = {0.5, 0.8, 1.1};
  const std::string folder = (fs::path(testing::TempDir()) / "nextview-view-bounds").string();
  fs::remove_all(folder);
  EXPECT_EQ(kept_view_bounds(folder, "digest", question), std::nullopt);
  const std::vector<ViewBound> bounds = view_bounds(folder, scene, "digest", question);
  ASSERT_EQ(bounds.size(), 3u);
  for (const ViewBound& bound : {bounds[0], bounds[1]}) {
    EXPECT_TRUE(bound.reached);
    EXPECT_GE(bound.greedy_views, bound.fewest_views);
    EXPECT_GE(bound.fewest_views, 2);
    EXPECT_GE(bound.greedy_m, bound.shortest_m);
  }
  EXPECT_LE(bounds[0].fewest_views, bounds[1].fewest_views);
  EXPECT_FALSE(bounds[2].reached);

  ASSERT_TRUE(keep_view_bounds(folder, "digest", question, bounds));
  EXPECT_EQ(kept_view_bounds(folder, "digest", question), bounds);
  question.poses.spacing_m = 0.4;
  EXPECT_EQ(kept_view_bounds(folder, "digest", question), std::nullopt);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace nextview
