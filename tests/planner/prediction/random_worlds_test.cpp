// Random small worlds, seen by sensors of all kinds and folded by the fast map update: every label,
// surface, area, quality and digest is that of the plain twin, and whatever is predicted from the
// fast structures, from anywhere, has the counts and the fitness that the definitions give on the
// plain twin's map.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
#include <utility>
#include <vector>

#include "planner/fitness.h"
#include "planner/prediction/fast_view_predictor.h"
#include "planner/prediction/panorama_view_predictor.h"
#include "tests/mapper/plain_digest.h"
#include "tests/mapper/same_map.h"
#include "tests/mapper/small_world.h"
#include "tests/planner/prediction/plain_gain.h"

namespace nextview {
namespace {

// A map that holds what the plain twin says.
VoxelMap map_of(const ReferenceMapUpdate& reference, const SmallWorld& world) {
  VoxelMap map(world.grid, world.window);
  for_each_voxel(world.window, [&](const VoxelIndex& voxel) {
    map.set_label(voxel, reference.label(voxel));
    const SurfaceVoxel* const surface = reference.surface(voxel);
    if (surface != nullptr) map.surface_at(voxel) = *surface;
  });
  return map;
}

// Eq. 3 and 4 as they are written, with f_quality or without.
double written_fitness(const ViewCounts& counts, bool with_quality) {
  const double met = static_cast<double>(counts.occupied + counts.occlusion_plane + counts.unseen);
  if (met == 0.0) return 0.0;
  const double a_ov = static_cast<double>(counts.occupied) / met;
  const double a_op = static_cast<double>(counts.occlusion_plane) / met;
  const double a_us = static_cast<double>(counts.unseen) / met;
  const double f_area = (5.0 * std::pow(a_ov, 3) - 10.5 * std::pow(a_ov, 2) + 6.0 * a_ov) *
                        (1.0 - std::abs(a_op - a_us) / 2.0);
  if (!with_quality || counts.improved_voxels == 0) return f_area;
  const double share =
      static_cast<double>(counts.improved_voxels) / static_cast<double>(counts.occupied_voxels);
  const double mean = static_cast<double>(counts.improvement) / SurfaceVoxel::kQualityUnit /
                      static_cast<double>(counts.improved_voxels);
  return f_area * (1.0 + share * mean);
}

void expect_fitness(const ViewCounts& counts, const ViewCounts& plain, bool with_quality) {
  FactorWeights weights = {};
  if (with_quality) weights[kQualityFactor] = 1.0;
  EXPECT_NEAR(fitness(counts, Travel{}, weights).value, written_fitness(plain, with_quality),
              1e-12);
}

// The panorama's definition, one ray of a view after the other: each counts for the cell it lies
// in, and the cell's own ray decides.
class PlainPanorama {
 public:
  PlainPanorama(const PredictionRaster& raster, const std::vector<Orientation>& orientations)
      : raster_(raster), orientations_(orientations) {}

  std::vector<ViewCounts> predict(const VoxelMap& map, const VoxelIndex& sensor) const {
    std::vector<ViewCounts> views;
    for (const Orientation& orientation : orientations_) {
      const Eigen::Matrix3d rotation =
          world_from_sensor_rotation(orientation.pan_rad, orientation.tilt_rad);
      ViewCounts& counts = views.emplace_back();
      for (int v = 0; v < raster_.rays.rows(); ++v) {
        for (int u = 0; u < raster_.rays.columns(); ++u) {
          count(map, sensor, middle_of_cell(rotation * raster_.rays.ray(u, v)), counts);
        }
      }
    }
    return views;
  }

 private:
  // Cells are even in angle on each face of a cube.
  static Eigen::Vector3d middle_of_cell(const Eigen::Vector3d& direction) {
    constexpr int kSide = PanoramaViewPredictor::kFaceSide;
    constexpr double kCell = std::numbers::pi / 2.0 / kSide;
    int axis = 0;
    direction.cwiseAbs().maxCoeff(&axis);
    Eigen::Vector3d middle;
    for (int other = 0; other < 3; ++other) {
      const double angle = std::atan(direction[other] / std::abs(direction[axis]));
      const int cell = std::clamp(
          static_cast<int>((angle / (std::numbers::pi / 4.0) + 1.0) * (kSide / 2)), 0, kSide - 1);
      middle[other] = std::tan((cell + 0.5 - kSide / 2) * kCell);
    }
    middle[axis] = direction[axis] < 0.0 ? -1.0 : 1.0;
    return middle.normalized();
  }

  void count(const VoxelMap& map, const VoxelIndex& sensor, const Eigen::Vector3d& direction,
             ViewCounts& counts) const {
    const IntegerLine line =
        line_along(sensor, direction, prediction_reach(raster_, map.grid().voxel_size_m));
    for (int k = 1; k <= line.steps && map.contains(line.at(k)); ++k) {
      switch (map.label(line.at(k))) {
        case Label::Empty:
          continue;
        case Label::Unmarked:
        case Label::Occluded:
          ++counts.unseen;
          return;
        case Label::OcclusionPlane:
          ++counts.occlusion_plane;
          return;
        case Label::Occupied:
          ++counts.occupied;
          return;
      }
    }
    ++counts.open;
  }

  PredictionRaster raster_;
  std::vector<Orientation> orientations_;
};

// Some of the icosahedron's, along axes, and any.
std::vector<Orientation> random_orientations(RandomStream& random) {
  std::vector<Orientation> orientations;
  for (const Orientation& orientation : icosahedron_orientations()) {
    if (random.below(3) == 0) orientations.push_back(orientation);
  }
  for (int n = 0; n < 4; ++n) {
    double pan = uniform(random, -std::numbers::pi, std::numbers::pi);
    double tilt = uniform(random, -0.5, 0.5) * std::numbers::pi;
    if (n % 2 == 0) {
      pan = 0.5 * std::numbers::pi * uniform_int(random, -2, 2);
      tilt = 0.5 * std::numbers::pi * uniform_int(random, -1, 1);
    }
    orientations.push_back({pan, tilt, viewing_direction(pan, tilt)});
  }
  return orientations;
}

// Anywhere in a window, often in its corners or at its faces, and more often where a sensor could
// be.
VoxelIndex random_place(const VoxelMap& map, RandomStream& random) {
  const MapWindow& window = map.window();
  const bool anywhere = random.below(3) == 0;
  VoxelIndex place = window.min;
  for (int draw = 0; draw < 100; ++draw) {
    for (int axis = 0; axis < 3; ++axis) {
      const int last = window.size[axis] - 1;
      const std::uint32_t end = random.below(8);
      place[axis] = window.min[axis] + (end == 0   ? 0
                                        : end == 1 ? last
                                                   : uniform_int(random, 0, last));
    }
    if (anywhere || map.label(place) == Label::Empty) break;
  }
  return place;
}

PredictionRaster random_raster(RandomStream& random) {
  const RangeLimits limits{0.0, random.below(2) == 0 ? 30.0 : uniform(random, 0.1, 4.0)};
  return prediction_raster(random_sensor(random), limits, {13, 9});
}

// One world: the fast map with all that follows it, and the plain twin.
struct FuzzedWorld {
  explicit FuzzedWorld(RandomStream& random)
      : world(random_small_world(random)),
        builder(world.grid, world.window),
        reference(world.grid, world.window),
        space(builder.map(), KnownSpace::Surfaces::Keep) {}

  void fold(const RangeImage& image) {
    const FoldReport& report = builder.fold(image);
    reference.fold(image);
    space.update(report.changed_slots, report.updated_surfaces);
  }
  void expect_map_of_twin() {
    expect_equal_maps(builder.map(), reference);
    expect_equal_statistics(builder.statistics(), reference.statistics());
    EXPECT_EQ(builder.digest(), plain_digest(reference, world.window));
  }

  SmallWorld world;
  MapBuilder builder;
  ReferenceMapUpdate reference;
  KnownSpace space;
};

struct Seen {
  std::int64_t views = 0;
  std::int64_t predicted = 0;
  std::int64_t improved = 0;
  std::int64_t met[4] = {0, 0, 0, 0};  // Occupied, planes, unseen, open

  void add(const ViewCounts& counts) {
    ++predicted;
    improved += counts.improved_voxels;
    met[0] += counts.occupied;
    met[1] += counts.occlusion_plane;
    met[2] += counts.unseen;
    met[3] += counts.open;
  }
};

void expect_predictions_of_twin(const FuzzedWorld& fuzzed, RandomStream& random, Seen& seen) {
  const double voxel_size_m = fuzzed.world.grid.voxel_size_m;
  const VoxelMap plain_map = map_of(fuzzed.reference, fuzzed.world);
  const KnownSpace plain_space(plain_map);
  const PredictionRaster raster = random_raster(random);
  const std::vector<Orientation> orientations = random_orientations(random);
  const bool quality = random.below(2) == 0;
  PlainViewPredictor plain(raster, voxel_size_m, orientations, quality);
  FastViewPredictor fast(raster, voxel_size_m, orientations, quality);
  const PlainPanorama plain_panorama(raster, orientations);
  PanoramaViewPredictor panorama(raster, voxel_size_m, orientations, false);
  std::vector<ViewCounts> expected(orientations.size());
  std::vector<ViewCounts> counts(orientations.size());
  for (int n = 0; n < 3; ++n) {
    const VoxelIndex sensor = random_place(plain_map, random);
    SCOPED_TRACE(testing::Message() << "from " << sensor.transpose());
    plain.predict(plain_space, sensor, expected);
    fast.predict(fuzzed.space, sensor, counts);
    EXPECT_EQ(counts, expected);
    for (std::size_t i = 0; i < counts.size(); ++i) {
      expect_fitness(counts[i], expected[i], quality);
      seen.add(counts[i]);
    }
    panorama.predict(fuzzed.space, sensor, counts);
    expected = plain_panorama.predict(plain_map, sensor);
    EXPECT_EQ(counts, expected);
    for (std::size_t i = 0; i < counts.size(); ++i) {
      expect_fitness(counts[i], expected[i], false);
    }
  }
}

TEST(RandomWorlds, EveryLabelAreaAndFitnessIsThePlainOne) {
  Seen seen;
  for (int n = 0; n < 1000; ++n) {
    SCOPED_TRACE("world " + std::to_string(n));
    RandomStream random(n, 2, 1, RandomPurpose::RangeNoise);
    FuzzedWorld fuzzed(random);
    for (int view = uniform_int(random, 1, 4); view > 0; --view) {
      fuzzed.fold(random_view(fuzzed.world, random_sensor(random), random));
      fuzzed.expect_map_of_twin();
      expect_predictions_of_twin(fuzzed, random, seen);
      ++seen.views;
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(seen.views, 2000);
  EXPECT_GT(seen.predicted, 60'000);
  EXPECT_GT(seen.improved, 3000);
  for (const std::int64_t met : seen.met) EXPECT_GT(met, 50'000);
  std::cout << seen.views << " views folded, " << seen.predicted << " predicted; rays met "
            << seen.met[0] << " Occupied, " << seen.met[1] << " planes, " << seen.met[2]
            << " unseen, " << seen.met[3] << " nothing\n";
}

TEST(RandomWorlds, WhatSurfacesAreExpectedToShowIsThePlainSum) {
  int compared = 0;
  int promising = 0;
  std::size_t grown_voxels = 0;
  for (int n = 0; n < 200; ++n) {
    SCOPED_TRACE("world " + std::to_string(n));
    RandomStream random(n, 2, 2, RandomPurpose::RangeNoise);
    FuzzedWorld fuzzed(random);
    for (int view = uniform_int(random, 1, 4); view > 0; --view) {
      fuzzed.fold(random_view(fuzzed.world, random_sensor(random), random));
    }
    fuzzed.expect_map_of_twin();
    const GrownSurface grown(fuzzed.builder.map());
    const VoxelMap plain_map = map_of(fuzzed.reference, fuzzed.world);
    const FreeSpaceField plain_field(plain_map);
    const GrownSurface plain_grown(plain_map);
    grown_voxels += plain_grown.size();
    const PredictionRaster raster = random_raster(random);
    const std::vector<Orientation> orientations = random_orientations(random);
    const PanoramaViews views(raster.rays, orientations);
    SurfaceGain gain(raster, fuzzed.world.grid.voxel_size_m, orientations, {});
    std::vector<std::uint8_t> in_vain(fuzzed.space.field().size(), 0);
    for (std::uint8_t& vain : in_vain) vain = static_cast<std::uint8_t>(random.below(3));
    const SurfaceGain::Known known{fuzzed.space.field(), in_vain, &grown};
    const VoxelIndex sensor = random_place(plain_map, random);
    gain.look_from(known, sensor);
    const PlainGain plain(plain_map, plain_field, in_vain, plain_grown, sensor,
                          prediction_reach(raster, fuzzed.world.grid.voxel_size_m),
                          gain.parameters().unknown_weight);
    for (std::size_t i = 0; i < orientations.size(); ++i) {
      std::vector<int> cells;
      views.for_each_cell(i, [&](int cell) { cells.push_back(cell); });
      const ExpectedView expected = plain.view(cells);
      // Each cell's two parts are rounded down to 1/65536, twice.
      const double rounding = 4.0 * static_cast<double>(cells.size()) / SurfaceGain::kUnit;
      EXPECT_NEAR(gain.view(i).new_voxels, expected.new_voxels, rounding);
      EXPECT_NEAR(gain.view(i).overlap, expected.overlap, 1e-9);
      EXPECT_EQ(gain.counts(known, i), plain.counts(cells));
      promising += expected.new_voxels > 1.0;
      ++compared;
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(compared, 1500);
  EXPECT_GT(promising, 300);
  EXPECT_GT(grown_voxels, 1000u);
}

}  // namespace
}  // namespace nextview
