#include "planner/paper_tidy_up_strategy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "base_sim/base.h"
#include "planner/paper_strategy.h"
#include "planner/prediction/fast_view_predictor.h"
#include "planner/view_planner.h"
#include "scene/scene.h"
#include "sensor_sim/scan.h"
#include "tests/scoring/room_mesh.h"

namespace nextview {
namespace {

constexpr double kVoxel_m = 0.1;

// The scan at the start, then so many views of 1 m2 and so many of some area.
std::vector<ViewFacts> views_of(std::size_t full, std::size_t late, double late_m2) {
  std::vector<ViewFacts> views = {{50.0, 0.0, 0.0}};
  views.insert(views.end(), full, {1.0, 0.0, 0.0});
  views.insert(views.end(), late, {late_m2, 0.0, 0.0});
  return views;
}

TEST(TidyUp, BeginsWhenTheLastViewsCoverLessThanHalfOfTheMean) {
  const TidyUpParameters half_over_five{.fallen_yield = 0.5, .yield_views = 5};
  // Half the means of 15 views: 12.25 / 30 = 0.408 and 11.5 / 30 = 0.383.
  EXPECT_FALSE(yield_has_fallen(views_of(10, 5, 0.45), half_over_five));
  EXPECT_TRUE(yield_has_fallen(views_of(10, 5, 0.3), half_over_five));
  EXPECT_FALSE(yield_has_fallen(views_of(10, 3, 0.3), half_over_five))
      << "two of the five are full";
}

TEST(TidyUp, DoesNotBeginAfterAFewViews) {
  const TidyUpParameters half_over_five{.fallen_yield = 0.5, .yield_views = 5};
  EXPECT_FALSE(yield_has_fallen(views_of(4, 5, 0.0), half_over_five));
  EXPECT_TRUE(yield_has_fallen(views_of(5, 5, 0.0), half_over_five));
}

TEST(TidyUp, ParametersThatCannotBeAreNamed) {
  const auto refused = [&](auto change) {
    TidyUpParameters changed;
    changed.view.field.spacing_rad = 0.02;
    changed.check();
    change(changed);
    EXPECT_THROW(changed.check(), std::invalid_argument);
  };
  refused([](TidyUpParameters& p) { p.fallen_yield = 1.5; });
  refused([](TidyUpParameters& p) { p.yield_views = 0; });
  refused([](TidyUpParameters& p) { p.largest_hole_m = 0.0; });
  refused([](TidyUpParameters& p) { p.view.min_cosine = 2.0; });
  refused([](TidyUpParameters& p) { p.feasibility.clearance_m = -1.0; });
}

// A room with two boxes, one of which stands before a niche.
TriangleMesh furnished_room() {
  TriangleMesh mesh = room({3.6, 2.8, 2.4});
  add_box(mesh, {1.5, 1.5, 0.0}, {2.1, 2.1, 1.2});
  add_box(mesh, {2.8, 0.0, 0.0}, {3.0, 1.0, 1.5});
  return mesh;
}

struct Recovered {
  std::vector<double> occupied_m2;  // after each view
  std::vector<bool> tidied;         // whether view 2, 3, ... looks into a hole
  std::optional<Ending> ending;
  std::size_t left_in_sight = 0;  // voxels of holes in sight of a voxel with a path, at the end
  std::size_t holes_at_tidy_up = 0;

  // 0 when it never had so much.
  int views_to(double area_m2) const {
    for (std::size_t i = 0; i < occupied_m2.size(); ++i) {
      if (occupied_m2[i] >= area_m2) return static_cast<int>(i) + 1;
    }
    return 0;
  }
};

struct World {
  explicit World(const TriangleMesh& mesh) : scene(mesh), bounds(mesh.bounds_m()) {
    limits.workspace_min_m = bounds.min();
    limits.workspace_max_m = bounds.max();
    limits.lift_max_m = 2.2;
    search.feasibility.workspace_min_m = bounds.min();
    search.feasibility.workspace_max_m = bounds.max();
    search.feasibility.lift_min_m = limits.lift_min_m;
    search.feasibility.lift_max_m = limits.lift_max_m;
    tidy_up.view.field = field_of_view(rays);
    tidy_up.feasibility = search.feasibility;
    stop.stop_window_views = 8;
  }

  std::unique_ptr<Strategy> strategy(bool tidy) const {
    const auto predictor = [](int columns, int rows) {
      const double aperture_rad = TiltedLineScan::paper().horizontal_aperture_rad;
      return std::make_unique<FastViewPredictor>(
          prediction_raster(TiltedLineScan::with_aperture(columns, rows, aperture_rad), {}),
          kVoxel_m, icosahedron_orientations(), false);
    };
    auto simplex = std::make_unique<PaperStrategy>(search, stop, kVoxel_m, predictor(64, 30),
                                                   predictor(16, 7));
    if (!tidy) return simplex;
    return std::make_unique<PaperTidyUpStrategy>(std::move(simplex), stop, tidy_up,
                                                 prediction_raster(TiltedLineScan::paper(), {}),
                                                 kVoxel_m);
  }

  Scene scene;
  Eigen::AlignedBox3d bounds;
  RayTable rays = make_ray_table(TiltedLineScan::paper());
  BaseLimits limits;
  PlannerParameters search;
  StopParameters stop;
  TidyUpParameters tidy_up;
};

std::size_t holes_in_sight(const World& world, const VoxelMap& map, const SensorPose& pose) {
  const ClearSpace clear(map, world.search.feasibility);
  ShortestPaths paths;
  paths.find(clear, map, pose.position_m, world.search.feasibility.departure_m);
  const FreeSpaceField field(map);
  std::size_t voxels = 0;
  for (const SurfaceHole& hole : surface_holes(map, 10)) {
    for (const HoleVoxel& voxel : hole.voxels) {
      for (const VoxelIndex& from : paths.reached()) {
        const Eigen::Vector3d out = (from - voxel.voxel).cast<double>();
        const double least = world.tidy_up.view.min_cosine * out.norm();
        if (!voxel.outward.isZero() && out.dot(voxel.outward) < least) continue;
        if (!is_in_sight(field, from, voxel.voxel)) continue;
        ++voxels;
        break;
      }
    }
  }
  return voxels;
}

Recovered recover(const World& world, bool tidy, std::int64_t seed, int most_views) {
  SensorPose pose{{0.7, 0.7, 1.2}, 0.0, 0.0};
  Base base(world.limits, pose, world.scene);
  const VoxelIndex end = VoxelGrid{kVoxel_m}.voxel_of(world.bounds.max()) + VoxelIndex(2, 2, 2);
  ViewPlanner planner({kVoxel_m}, {VoxelIndex::Constant(-2), end + VoxelIndex(2, 2, 2)},
                      world.strategy(tidy), {.seed = seed, .max_views = most_views});
  Recovered run;
  double occupied_m2 = 0.0;
  for (;;) {
    RandomStream no_noise(seed, planner.views() + 1, 1, RandomPurpose::RangeNoise);
    const FoldReport& report =
        planner.fold(scan(world.scene, world.rays, RangeLimits(), pose, 0.0, no_noise));
    occupied_m2 += view_facts(report, {}, kVoxel_m).newly_occupied_area_m2;
    run.occupied_m2.push_back(occupied_m2);
    for (bool arrived = false; !arrived;) {
      const NextView next = planner.next_view();
      if (const Ending* ending = std::get_if<Ending>(&next)) {
        run.ending = *ending;
        run.left_in_sight = holes_in_sight(world, planner.map(), pose);
        return run;
      }
      const Decision& decision = std::get<Decision>(next);
      EXPECT_EQ(decision.strategy,
                tidy ? PaperTidyUpStrategy::kFacts.name : PaperStrategy::kFacts.name);
      arrived = base.move(decision.waypoints_m, decision.pose).arrived;
      if (!arrived) {
        planner.refuse();
        continue;
      }
      run.tidied.push_back(decision.reason.starts_with("looks into"));
      if (run.tidied.back() && run.holes_at_tidy_up == 0) {
        run.holes_at_tidy_up = holes_in_sight(world, planner.map(), pose);
      }
      pose = decision.pose;
    }
  }
}

TEST(TidyUp, TakesOverFromTheSimplexAndLeavesNoHoleThatCanBeLookedInto) {
  const World world(furnished_room());
  for (int seed = 1; seed <= 3; ++seed) {
    const Recovered run = recover(world, true, seed, 200);
    ASSERT_EQ(run.ending->reason, StopReason::NothingLeft) << run.ending->detail;
    EXPECT_NE(run.ending->detail.find("boundary left unseen"), std::string::npos);
    EXPECT_GT(run.holes_at_tidy_up, 50u);
    // Looked into in vain: corners that the sensor's rays pass by.
    EXPECT_LT(20 * run.left_in_sight, run.holes_at_tidy_up) << run.left_in_sight;
    const auto first = std::ranges::find(run.tidied, true);
    EXPECT_GE(first - run.tidied.begin(), 10);
    EXPECT_EQ(std::find(first, run.tidied.end(), false), run.tidied.end());
  }
}

TEST(TidyUp, TakesFewerViewsThanTheSimplexAlone) {
  const World world(furnished_room());
  int alone = 0;
  int tidied = 0;
  for (int seed = 1; seed <= 3; ++seed) {
    const Recovered with = recover(world, true, seed, 200);
    const double most_of_it_m2 = 0.98 * with.occupied_m2.back();
    const Recovered without = recover(world, false, seed, 200);
    const int views = without.views_to(most_of_it_m2);
    tidied += with.views_to(most_of_it_m2);
    alone += views > 0 ? views : static_cast<int>(without.occupied_m2.size());
  }
  EXPECT_LT(5 * tidied, 4 * alone) << tidied << " and " << alone;
}

// Under the rules that ask for quality the simplex goes on when there is no hole left.
TEST(TidyUp, GivesBackToTheSimplexForQuality) {
  World world(furnished_room());
  world.stop.rule = StopRule::Quality;
  world.stop.quality_threshold = 1.0;
  const Recovered run = recover(world, true, 1, 90);
  EXPECT_EQ(run.ending->reason, StopReason::ViewLimit);
  const auto first = std::ranges::find(run.tidied, true);
  const auto back = std::find(first, run.tidied.end(), false);
  ASSERT_NE(first, run.tidied.end());
  ASSERT_NE(back, run.tidied.end());
  EXPECT_EQ(std::find(back, run.tidied.end(), true), run.tidied.end());
}

}  // namespace
}  // namespace nextview
