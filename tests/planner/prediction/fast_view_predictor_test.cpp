#include "planner/prediction/fast_view_predictor.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <numbers>
#include <random>
#include <vector>

#include "sensor/sensor_pose.h"

namespace nextview {
namespace {

constexpr double kVoxelSize = 0.1;

// A room of free space with random blocks of everything in it, and random surfaces.
VoxelMap random_map(std::mt19937& random, const VoxelIndex& min, const VoxelIndex& size) {
  VoxelMap map({kVoxelSize, Eigen::Vector3d::Zero()}, {min, size});
  const auto below = [&random](int n) {
    return static_cast<int>(random() % static_cast<unsigned>(n));
  };
  std::fill(map.labels().begin(), map.labels().end(), Label::Empty);
  for (int block = below(25); block > 0; --block) {
    const VoxelIndex corner = min + VoxelIndex(below(size[0]), below(size[1]), below(size[2]));
    const VoxelIndex extent = VoxelIndex(1 + below(6), 1 + below(6), 1 + below(6));
    const auto label = static_cast<Label>(below(5));
    for (int k = 0; k < extent[2]; ++k) {
      for (int j = 0; j < extent[1]; ++j) {
        for (int i = 0; i < extent[0]; ++i) {
          const VoxelIndex index = corner + VoxelIndex(i, j, k);
          if (!map.contains(index)) continue;
          map.set_label(index, label);
          if (label != Label::Occupied || below(8) == 0) continue;
          SurfaceVoxel& surface = map.surface_at(index);
          surface.normal_sum = {below(40000) - 20000, below(40000) - 20000, below(40000) - 20000};
          surface.quality = static_cast<std::uint16_t>(below(65536));
        }
      }
    }
  }
  return map;
}

PredictionRaster small_raster(int columns, int rows, double aperture_rad, double range_max_m) {
  return {make_ray_table(TiltedLineScan::with_aperture(columns, rows, aperture_rad)), range_max_m};
}

// Axis-parallel, diagonal and icosahedron directions.
std::vector<Orientation> directions() {
  std::vector<Orientation> all = icosahedron_orientations();
  for (int quarter = 0; quarter < 8; ++quarter) {
    const double pan = quarter * std::numbers::pi / 4.0;
    for (const double tilt : {0.0, std::numbers::pi / 4.0, -std::numbers::pi / 2.0}) {
      all.push_back({pan, tilt, viewing_direction(pan, tilt)});
    }
  }
  return all;
}

// Compares the two predictors from random places of random maps; returns the rays compared.
std::int64_t compare(unsigned seed, int maps, int places, int threads) {
  std::mt19937 random(seed);
  std::int64_t rays = 0;
  for (int round = 0; round < maps; ++round) {
    const VoxelIndex size(3 + static_cast<int>(random() % 60), 3 + static_cast<int>(random() % 40),
                          3 + static_cast<int>(random() % 30));
    const VoxelIndex min(-static_cast<int>(random() % 50), static_cast<int>(random() % 50), -5);
    const VoxelMap map = random_map(random, min, size);
    const KnownSpace space(map, KnownSpace::Surfaces::Keep, threads);
    // An odd raster, so that bundles need padding, whose middle column and row are axis-parallel.
    const double range_max_m = round % 3 == 0 ? 1.7 : 30.0;
    const PredictionRaster raster =
        round % 4 == 3
            ? PredictionRaster{make_ray_table(SphericalScanner{16, 9, 2.0 * std::numbers::pi, 1.7}),
                               range_max_m}
            : small_raster(15, 9, std::numbers::pi / 3.0, range_max_m);
    PlainViewPredictor plain(raster, kVoxelSize, directions(), true);
    FastViewPredictor fast(raster, kVoxelSize, directions(), true, threads);
    std::vector<ViewCounts> expected(directions().size());
    std::vector<ViewCounts> counts(directions().size());
    for (int place = 0; place < places; ++place) {
      // Corners and faces of the window as well as its inside.
      VoxelIndex sensor;
      for (int axis = 0; axis < 3; ++axis) {
        const auto extent = static_cast<unsigned>(size[axis]);
        const auto choice = random() % 4;
        const auto cell = choice == 0 ? 0 : choice == 1 ? extent - 1 : random() % extent;
        sensor[axis] = min[axis] + static_cast<int>(cell);
      }
      plain.predict(space, sensor, expected);
      fast.predict(space, sensor, counts);
      EXPECT_TRUE(std::equal(counts.begin(), counts.end(), expected.begin()))
          << "map " << round << " from " << sensor.transpose();
      rays += static_cast<std::int64_t>(raster.rays.pixels() * counts.size());
    }
  }
  return rays;
}

TEST(FastViewPredictor, AgreesWithThePlainOneOverAMillionRays) {
  EXPECT_GE(compare(1, 40, 6, 1), 1'000'000);
}

TEST(FastViewPredictor, AgreesOnEveryInstructionSetOfThisProcessor) {
  const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  ASSERT_FALSE(targets.empty());
  for (const std::int64_t target : targets) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    SCOPED_TRACE(ray_kernel_target());
    EXPECT_GE(compare(2, 10, 4, 1), 200'000);
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

TEST(FastViewPredictor, AgreesWhateverTheNumberOfThreads) {
  for (const int threads : {2, 3, 7}) EXPECT_GE(compare(3, 6, 4, threads), 100'000);
}

// As in a program that has used up its threads: a region within a region has one.
TEST(FastViewPredictor, AgreesWithFewerThreadsThanAskedFor) {
#pragma omp parallel num_threads(2)
#pragma omp single
  EXPECT_GE(compare(4, 6, 4, 3), 100'000);
}

// In a space that is told of everything that happens to a map whose window moves, the same as the
// plain predictor reads from the map itself. Its rays, surfaces and all.
TEST(FastViewPredictor, FollowsAWindowThatMoves) {
  std::mt19937 random(6);
  const auto below = [&random](int n) {
    return static_cast<int>(random() % static_cast<unsigned>(n));
  };
  const VoxelIndex size(40, 30, 20);
  VoxelMap map = random_map(random, VoxelIndex::Zero(), size);
  KnownSpace space(map, KnownSpace::Surfaces::Keep);
  const PredictionRaster raster = small_raster(15, 9, std::numbers::pi / 3.0, 30.0);
  PlainViewPredictor plain(raster, kVoxelSize, directions(), true);
  FastViewPredictor fast(raster, kVoxelSize, directions(), true);
  std::vector<ViewCounts> expected(directions().size());
  std::vector<ViewCounts> counts(directions().size());
  std::int64_t improved = 0;
  for (int round = 0; round < 60; ++round) {
    const int reach = round % 10 == 9 ? 50 : 4;
    const VoxelIndex step(below(2 * reach + 1) - reach, below(2 * reach + 1) - reach, below(3) - 1);
    map.move_window(map.window().min + step);
    space.update({}, {});
    const VoxelIndex sensor =
        map.window().min + VoxelIndex(below(size[0]), below(size[1]), below(size[2]));
    plain.predict(space, sensor, expected);
    fast.predict(space, sensor, counts);
    ASSERT_TRUE(std::equal(counts.begin(), counts.end(), expected.begin())) << "round " << round;

    // What has been entered is filled, in part with surfaces that may lack a normal.
    std::vector<std::uint32_t> slots;
    std::vector<std::uint32_t> surfaces;
    for_each_voxel(map.window(), [&](const VoxelIndex& voxel) {
      if (map.label(voxel) != Label::Unmarked) return;
      const auto slot = static_cast<std::uint32_t>(map.slot(voxel));
      slots.push_back(slot);
      map.set_label(voxel, below(40) > 0 ? Label::Empty : Label::Occupied);
      if (map.label(voxel) == Label::Empty || below(4) == 0) return;
      SurfaceVoxel& surface = map.surface_at(voxel);
      surface.normal_sum = {below(40000) - 20000, below(40000) - 20000, below(40000) - 20000};
      surface.quality = static_cast<std::uint16_t>(below(65536));
      surfaces.push_back(slot);
    });
    space.update(slots, surfaces);
    plain.predict(space, sensor, expected);
    fast.predict(space, sensor, counts);
    ASSERT_TRUE(std::equal(counts.begin(), counts.end(), expected.begin())) << "round " << round;
    for (const ViewCounts& view : counts) improved += view.improved_voxels;
  }
  EXPECT_GT(improved, 10'000);
}

TEST(FastViewPredictor, PredictsFromSeveralSensorsAsFromOneAfterTheOther) {
  std::mt19937 random(5);
  const VoxelMap map = random_map(random, VoxelIndex::Zero(), {30, 25, 20});
  const KnownSpace space(map, KnownSpace::Surfaces::Keep);
  const PredictionRaster raster = small_raster(15, 9, std::numbers::pi / 3.0, 30.0);
  const std::vector<VoxelIndex> sensors = {{15, 12, 10}, {0, 0, 0}, {29, 3, 19}, {15, 12, 11}};
  const std::size_t views = directions().size();
  for (const bool quality : {false, true}) {
    for (const int threads : {1, 2, 3}) {
      FastViewPredictor fast(raster, kVoxelSize, directions(), quality, threads);
      std::vector<ViewCounts> counts(sensors.size() * views);
      fast.predict_all(space, sensors, counts);
      for (std::size_t i = 0; i < sensors.size(); ++i) {
        std::vector<ViewCounts> alone(views);
        fast.predict(space, sensors[i], alone);
        EXPECT_TRUE(std::equal(alone.begin(), alone.end(), &counts[i * views]))
            << "sensor " << i << ", " << threads << " threads";
      }
    }
  }
}

TEST(FastViewPredictor, WantsRoomForEveryViewOfEverySensor) {
  std::mt19937 random(7);
  const VoxelMap map = random_map(random, VoxelIndex::Zero(), {30, 25, 20});
  const KnownSpace space(map, KnownSpace::Surfaces::Keep);
  const PredictionRaster raster = small_raster(15, 9, std::numbers::pi / 3.0, 30.0);
  FastViewPredictor fast(raster, kVoxelSize, directions(), false, 1);
  const std::vector<VoxelIndex> sensors = {{15, 12, 10}, {3, 4, 5}};
  std::vector<ViewCounts> counts(2 * directions().size());
  EXPECT_NO_THROW(fast.predict_all(space, sensors, counts));
  EXPECT_NO_THROW(fast.predict_all(space, {}, {}));
  counts.pop_back();
  EXPECT_THROW(fast.predict_all(space, sensors, counts), std::invalid_argument);
  counts.resize(directions().size());
  EXPECT_THROW(fast.predict_all(space, sensors, counts), std::invalid_argument);
  const std::vector<VoxelIndex> outside = {{15, 12, 10}, {30, 4, 5}};
  counts.resize(2 * directions().size());
  EXPECT_THROW(fast.predict_all(space, outside, counts), std::invalid_argument);
}

TEST(FastViewPredictor, FollowsChangesOfTheMap) {
  std::mt19937 random(11);
  const VoxelIndex size(40, 30, 20);
  const PredictionRaster raster = small_raster(16, 8, std::numbers::pi / 3.0, 30.0);
  VoxelMap map = random_map(random, VoxelIndex::Zero(), size);
  PlainViewPredictor plain(raster, kVoxelSize, icosahedron_orientations(), true);
  FastViewPredictor fast(raster, kVoxelSize, icosahedron_orientations(), true);
  KnownSpace space(map, KnownSpace::Surfaces::Keep);
  std::vector<ViewCounts> expected(20);
  std::vector<ViewCounts> counts(20);
  for (int round = 0; round < 40; ++round) {
    const VoxelMap next = random_map(random, VoxelIndex::Zero(), size);
    std::vector<std::uint32_t> changed;
    std::vector<std::uint32_t> updated;
    for (int i = 0; i < 200; ++i) {
      const VoxelIndex index(static_cast<int>(random() % 40), static_cast<int>(random() % 30),
                             static_cast<int>(random() % 20));
      const auto slot = static_cast<std::uint32_t>(map.slot(index));
      if (map.label(index) != next.label(index)) {
        map.set_label(index, next.label(index));
        changed.push_back(slot);
      }
      if (map.label(index) == Label::Occupied) {
        map.surface_at(index).normal_sum = {static_cast<int>(random() % 100), -50, 7};
        updated.push_back(slot);
      }
    }
    space.update(changed, updated);
    plain.predict(space, VoxelIndex(20, 15, 10), expected);
    fast.predict(space, VoxelIndex(20, 15, 10), counts);
    ASSERT_EQ(counts, expected) << "round " << round;
  }
}

TEST(FastViewPredictor, KnowsOccupiedVoxelsWithoutSurfaceData) {
  // Points without a normal make a voxel Occupied and leave no surface data.
  VoxelMap map({kVoxelSize, Eigen::Vector3d::Zero()}, {VoxelIndex::Zero(), VoxelIndex(12, 12, 12)});
  std::fill(map.labels().begin(), map.labels().end(), Label::Empty);
  const PredictionRaster raster = small_raster(16, 8, std::numbers::pi / 3.0, 30.0);
  PlainViewPredictor plain(raster, kVoxelSize, icosahedron_orientations(), true);
  FastViewPredictor fast(raster, kVoxelSize, icosahedron_orientations(), true);
  KnownSpace space(map, KnownSpace::Surfaces::Keep);
  std::vector<std::uint32_t> changed;
  for (int i = 0; i < 12; ++i) {
    for (int k = 0; k < 12; ++k) {
      map.set_label({i, 11, k}, Label::Occupied);
      changed.push_back(static_cast<std::uint32_t>(map.slot({i, 11, k})));
    }
  }
  space.update(changed, {});
  std::vector<ViewCounts> expected(20);
  std::vector<ViewCounts> counts(20);
  plain.predict(space, VoxelIndex(6, 3, 6), expected);
  fast.predict(space, VoxelIndex(6, 3, 6), counts);
  EXPECT_EQ(counts, expected);
  EXPECT_TRUE(std::any_of(counts.begin(), counts.end(),
                          [](const ViewCounts& view) { return view.occupied_voxels > 20; }));
}

TEST(FastViewPredictor, SaysWhatItCannotDo) {
  const PredictionRaster raster = small_raster(4, 4, 1.0, 30.0);
  EXPECT_THROW(FastViewPredictor(raster, kVoxelSize, {}, false), std::invalid_argument);
  EXPECT_THROW(FastViewPredictor(raster, 0.0, directions(), false), std::invalid_argument);
  EXPECT_THROW(FastViewPredictor(raster, kVoxelSize, directions(), false, 0),
               std::invalid_argument);
  FastViewPredictor fast(raster, kVoxelSize, directions(), false);
  VoxelMap map({kVoxelSize, Eigen::Vector3d::Zero()}, {VoxelIndex::Zero(), VoxelIndex(8, 8, 8)});
  const KnownSpace space(map);
  std::vector<ViewCounts> counts(directions().size());
  EXPECT_THROW(fast.predict(space, VoxelIndex(8, 0, 0), counts), std::invalid_argument);
  counts.pop_back();
  EXPECT_THROW(fast.predict(space, VoxelIndex(1, 1, 1), counts), std::invalid_argument);
  FastViewPredictor with_quality(raster, kVoxelSize, directions(), true);
  counts.resize(directions().size());
  EXPECT_THROW(with_quality.predict(space, VoxelIndex(1, 1, 1), counts), std::logic_error);
}

}  // namespace
}  // namespace nextview
