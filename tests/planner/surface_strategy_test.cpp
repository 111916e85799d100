#include "planner/surface_strategy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "base_sim/base.h"
#include "planner/prediction/orientations.h"
#include "planner/view_planner.h"
#include "scene/scene.h"
#include "sensor_sim/scan.h"
#include "tests/scoring/room_mesh.h"

namespace nextview {
namespace {

using Eigen::Vector3d;

constexpr double kVoxel_m = 0.1;
const Vector3d kRoom_m(5.0, 3.0, 2.5);

TriangleMesh one_room() { return room({3.0, 3.0, 2.5}); }

// Two rooms, and between them a wall with a door from y = 1.8 on.
TriangleMesh two_rooms() {
  TriangleMesh mesh = room(kRoom_m);
  add_box(mesh, {2.45, 0.0, 0.0}, {2.55, 1.8, 2.5});
  return mesh;
}

struct Exploration {
  std::vector<SensorPose> poses;  // by view
  std::vector<Decision> decisions;
  std::optional<Ending> ending;
  std::optional<UnseenBoundary> left_unseen;
  double path_m = 0.0;
  int attempts_refused = 0;
  std::set<std::tuple<int, double, double, double>> refused;  // view and position
  double most_left_m2 = 0.0;     // that one more view would show, by the scene
  double walls_recovered = 0.0;  // share of the room's walls, floor and ceiling
};

// The share of points 0.1 m apart on the surface of a box whose voxel is Occupied.
double recovered(const VoxelMap& map, const Vector3d& size_m) {
  int occupied = 0;
  int points = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const int across = (axis + 1) % 3;
    const int up = (axis + 2) % 3;
    for (const double at : {0.0, size_m[axis]}) {
      for (double a = 0.1; a < size_m[across] - 0.05; a += 0.1) {
        for (double b = 0.1; b < size_m[up] - 0.05; b += 0.1) {
          Vector3d point;
          point[axis] = at;
          point[across] = a;
          point[up] = b;
          occupied += map.label(map.grid().voxel_of(point)) == Label::Occupied ? 1 : 0;
          ++points;
        }
      }
    }
  }
  return static_cast<double>(occupied) / points;
}

// By the scene itself: the new surface that the best view would really show from anywhere that a
// path leads to from the pose, positions 0.3 m apart and 80 orientations at each.
double most_left_m2(const VoxelMap& map, const Scene& scene, const SensorPose& pose,
                    const SurfaceParameters& parameters) {
  const ClearSpace space(map, parameters.feasibility);
  ShortestPaths paths;
  paths.find(space, map, pose.position_m, parameters.departure_m);
  const RayTable rays = make_ray_table(TiltedLineScan::paper());
  RandomStream no_noise(1, 1, 1, RandomPurpose::RangeNoise);
  std::size_t most = 0;
  for (const VoxelIndex& voxel : paths.reached()) {
    if (voxel[0] % 3 != 0 || voxel[1] % 3 != 0 || voxel[2] % 3 != 0) continue;
    for (const Orientation& orientation : icosahedron_orientations(1)) {
      const RangeImage image = scan(
          scene, rays, RangeLimits(),
          {map.grid().center_m(voxel), orientation.pan_rad, orientation.tilt_rad}, 0.0, no_noise);
      std::set<std::size_t> shown;  // slots
      for (int v = 0; v < rays.rows(); ++v) {
        for (int u = 0; u < rays.columns(); ++u) {
          const float range_m = image.range_m[static_cast<std::size_t>(v * rays.columns() + u)];
          if (!std::isfinite(range_m)) continue;
          const Vector3d point_m = image.position_m + image.world_from_sensor * rays.ray(u, v) *
                                                          static_cast<double>(range_m);
          const VoxelIndex at = map.grid().voxel_of(point_m);
          if (map.label(at) != Label::Occupied) shown.insert(map.slot(at));
        }
      }
      most = std::max(most, shown.size());
    }
  }
  return static_cast<double>(most) * kVoxel_m * kVoxel_m;
}

// Goes on until the strategy ends or there are 80 views; no goal with x beyond refuse_beyond_m is
// ever reached.
Exploration run_in(const TriangleMesh& mesh, SurfaceParameters parameters,
                   double refuse_beyond_m = std::numeric_limits<double>::infinity(),
                   int max_views = 80, bool check_what_is_left = false, int threads = 1) {
  const Scene scene(mesh);
  const Eigen::AlignedBox3d bounds = mesh.bounds_m();
  BaseLimits limits;
  limits.workspace_min_m = bounds.min();
  limits.workspace_max_m = bounds.max();
  limits.lift_max_m = 2.3;
  parameters.feasibility.workspace_min_m = bounds.min();
  parameters.feasibility.workspace_max_m = bounds.max();
  parameters.feasibility.lift_min_m = limits.lift_min_m;
  parameters.feasibility.lift_max_m = limits.lift_max_m;
  SensorPose pose{{0.7, 0.7, 1.2}, 0.0, 0.0};
  Base base(limits, pose, scene);

  auto strategy =
      std::make_unique<SurfaceStrategy>(prediction_raster(TiltedLineScan::paper(), RangeLimits()),
                                        kVoxel_m, icosahedron_orientations(2), parameters);
  const SurfaceStrategy& surface = *strategy;
  const VoxelIndex last = VoxelGrid{kVoxel_m}.voxel_of(bounds.max()) + VoxelIndex::Constant(2);
  ViewPlanner planner({kVoxel_m}, {VoxelIndex::Constant(-2), last + VoxelIndex::Constant(3)},
                      std::move(strategy), {.seed = 1, .max_views = max_views, .threads = threads});
  const RayTable rays = make_ray_table(TiltedLineScan::paper());
  Exploration run;
  while (!run.ending) {
    RandomStream no_noise(1, planner.views() + 1, 1, RandomPurpose::RangeNoise);
    planner.fold(scan(scene, rays, RangeLimits(), pose, 0.0, no_noise));
    run.poses.push_back(pose);
    for (;;) {
      const NextView next = planner.next_view();
      if (const Ending* ending = std::get_if<Ending>(&next)) {
        run.ending = *ending;
        break;
      }
      const Decision& decision = std::get<Decision>(next);
      run.decisions.push_back(decision);
      if (decision.pose.position_m.x() > refuse_beyond_m) {
        planner.refuse();
        ++run.attempts_refused;
        const Vector3d& at = decision.pose.position_m;
        run.refused.insert({planner.views() + 1, at.x(), at.y(), at.z()});
        continue;
      }
      const Motion motion = base.move(decision.waypoints_m, decision.pose);
      EXPECT_TRUE(motion.arrived) << motion.refusal;
      run.path_m += motion.path_length_m;
      pose = decision.pose;
      break;
    }
  }
  run.left_unseen = surface.left_unseen();
  if (check_what_is_left) {
    run.most_left_m2 = most_left_m2(planner.map(), scene, pose, parameters);
  }
  run.walls_recovered = recovered(planner.map(), bounds.max());
  return run;
}

double furthest_x(const Exploration& run) {
  double x = 0.0;
  for (const SensorPose& pose : run.poses) x = std::max(x, pose.position_m.x());
  return x;
}

TEST(SurfaceStrategy, GoesThroughTheDoorAndEndsWhenAllIsSeen) {
  const Exploration run = run_in(two_rooms(), {});
  EXPECT_EQ(run.ending->reason, StopReason::NothingLeft) << run.ending->detail;
  EXPECT_LT(run.poses.size(), 60u);
  EXPECT_GT(furthest_x(run), 3.0);
  EXPECT_GT(run.walls_recovered, 0.97);
  ASSERT_TRUE(run.left_unseen);
  EXPECT_LT(run.left_unseen->in_view_m2, 0.5);
  EXPECT_NE(run.ending->detail.find("left unseen"), std::string::npos);
  for (const Decision& decision : run.decisions) {
    EXPECT_NE(decision.reason.find("m2 of new surface"), std::string::npos) << decision.reason;
    EXPECT_GE(decision.overlap, 0.2);
    EXPECT_GT(decision.expected_gain_m2, 0.0);
    EXPECT_GE(decision.evaluations, static_cast<int>(decision.tried.size()));
    EXPECT_FALSE(decision.tried.empty());
  }
}

TEST(SurfaceStrategy, LeavesNoViewThatWouldShowMuch) {
  const Exploration run =
      run_in(two_rooms(), {}, std::numeric_limits<double>::infinity(), 80, true);
  EXPECT_EQ(run.ending->reason, StopReason::NothingLeft) << run.ending->detail;
  EXPECT_LT(run.most_left_m2, 0.5);
}

void expect_same(const Exploration& first, const Exploration& second) {
  EXPECT_EQ(first.ending->reason, StopReason::ViewLimit);
  ASSERT_EQ(first.poses.size(), second.poses.size());
  for (std::size_t i = 0; i < first.poses.size(); ++i) {
    EXPECT_EQ(first.poses[i].position_m, second.poses[i].position_m);
    EXPECT_EQ(first.poses[i].pan_rad, second.poses[i].pan_rad);
    EXPECT_EQ(first.poses[i].tilt_rad, second.poses[i].tilt_rad);
  }
}

TEST(SurfaceStrategy, DecidesTheSameAgainAndWithMoreThreads) {
  constexpr double kAnywhere = std::numeric_limits<double>::infinity();
  const Exploration first = run_in(one_room(), {}, kAnywhere, 8);
  expect_same(first, run_in(one_room(), {}, kAnywhere, 8));
  expect_same(first, run_in(one_room(), {}, kAnywhere, 8, false, 3));
}

TEST(SurfaceStrategy, NeverTriesARefusedGoalAgainAndSaysWhatItLeft) {
  const Exploration run = run_in(two_rooms(), {}, 2.4);
  EXPECT_EQ(run.ending->reason, StopReason::NothingLeft) << run.ending->detail;
  EXPECT_LE(furthest_x(run), 2.4);
  EXPECT_GT(run.attempts_refused, 0);
  EXPECT_LT(run.attempts_refused, 60);
  EXPECT_GT(run.left_unseen->refused_m2 + run.left_unseen->no_path_m2, 0.0);
  EXPECT_EQ(static_cast<int>(run.refused.size()), run.attempts_refused);
}

TEST(SurfaceStrategy, TradesViewsAgainstMetres) {
  SurfaceParameters few_metres;
  few_metres.path_cost_per_m = 1.0;
  SurfaceParameters few_views;
  few_views.path_cost_per_m = 0.0;
  const Exploration near = run_in(one_room(), few_metres);
  const Exploration far = run_in(one_room(), few_views);
  EXPECT_LT(near.path_m, 0.7 * far.path_m);
  EXPECT_GT(near.walls_recovered, 0.97);
  EXPECT_GT(far.walls_recovered, 0.97);
}

TEST(SurfaceStrategy, ComesHomeWhenAskedTo) {
  SurfaceParameters parameters;
  parameters.return_home = true;
  const Exploration run = run_in(one_room(), parameters);
  EXPECT_EQ(run.ending->reason, StopReason::NothingLeft);
  EXPECT_EQ(run.poses.back().position_m, run.poses.front().position_m);
  EXPECT_EQ(run.poses.back().pan_rad, run.poses.front().pan_rad);
}

TEST(SurfaceStrategy, NamesTheParameterThatCannotBe) {
  SurfaceParameters parameters;
  parameters.min_overlap = 1.0;
  try {
    parameters.check();
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("min_overlap"), std::string::npos);
  }
}

// A corridor along x whose far half is known to be Empty only beyond a hole too small for the body.
TEST(UnseenBoundary, SaysFromWhereWhatIsLeftCouldBeSeen) {
  VoxelMap map({kVoxel_m, Vector3d::Zero()}, {VoxelIndex::Zero(), VoxelIndex(60, 15, 30)});
  std::ranges::fill(map.labels(), Label::Occupied);
  const auto fill = [&](const VoxelIndex& min, const VoxelIndex& end, Label label) {
    for (int k = min[2]; k < end[2]; ++k) {
      for (int j = min[1]; j < end[1]; ++j) {
        for (int i = min[0]; i < end[0]; ++i) map.set_label({i, j, k}, label);
      }
    }
  };
  fill({2, 2, 2}, {25, 13, 13}, Label::Empty);    // where the robot is
  fill({25, 7, 7}, {30, 8, 8}, Label::Empty);     // a hole
  fill({30, 2, 2}, {55, 13, 13}, Label::Empty);   // clear, but no path leads there
  fill({5, 1, 5}, {6, 2, 6}, Label::Occluded);    // in a side wall: seen from the robot's part
  fill({45, 1, 5}, {46, 2, 6}, Label::Occluded);  // and from the other
  FeasibilityParameters parameters;
  const ClearSpace space(map, parameters);
  ShortestPaths paths;
  paths.find(space, map, {1.2, 0.7, 0.7}, 0.3);
  const std::vector<UnseenVoxel> unseen = unseen_voxels(map, space, paths, 10.0);
  ASSERT_EQ(unseen.size(), 2u);
  EXPECT_EQ(unseen[0].voxel, VoxelIndex(5, 1, 5));
  EXPECT_EQ(unseen[0].from, UnseenFrom::InView);
  EXPECT_EQ(unseen[1].voxel, VoxelIndex(45, 1, 5));
  EXPECT_EQ(unseen[1].from, UnseenFrom::NoPath);
  EXPECT_EQ(unseen[1].empty_faces, 1);
  const UnseenBoundary boundary = unseen_boundary(map, space, paths, 10.0);
  EXPECT_NEAR(boundary.in_view_m2, 0.01, 1e-9);
  EXPECT_NEAR(boundary.no_path_m2, 0.01, 1e-9);
  EXPECT_NEAR(boundary.total_m2(), 0.02, 1e-9);
  EXPECT_EQ(describe(boundary),
            "0.02 m2 of boundary left unseen: 0.01 m2 in view, where views show too little, "
            "0.01 m2 seen only from where no path leads");
}

}  // namespace
}  // namespace nextview
