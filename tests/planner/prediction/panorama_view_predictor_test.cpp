#include "planner/prediction/panorama_view_predictor.h"
#include "planner/fitness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace nextview {
namespace {

constexpr double kVoxelSize = 0.1;

PredictionRaster paper_raster(double range_max_m = 30.0) {
  return {make_ray_table(TiltedLineScan::paper()), range_max_m};
}

// A closed room of free space, partly seen: some of its wall is Occupied, the rest unknown.
VoxelMap room(std::mt19937& random) {
  const VoxelIndex size(52, 44, 31);
  VoxelMap map({kVoxelSize, Eigen::Vector3d::Zero()}, {VoxelIndex::Zero(), size});
  const auto below = [&random](int n) {
    return static_cast<int>(random() % static_cast<unsigned>(n));
  };
  for (int k = 1; k < size[2] - 1; ++k) {
    for (int j = 1; j < size[1] - 1; ++j) {
      for (int i = 1; i < size[0] - 1; ++i) map.set_label({i, j, k}, Label::Empty);
    }
  }
  for (int block = 0; block < 40; ++block) {
    const VoxelIndex corner(below(size[0]), below(size[1]), below(size[2]));
    const VoxelIndex extent(2 + below(12), 2 + below(12), 2 + below(12));
    const auto label = static_cast<Label>(below(5));
    for (int k = 0; k < extent[2]; ++k) {
      for (int j = 0; j < extent[1]; ++j) {
        for (int i = 0; i < extent[0]; ++i) {
          const VoxelIndex index = corner + VoxelIndex(i, j, k);
          const bool wall = (index.array() == 0).any() || (index.array() == size.array() - 1).any();
          if (map.contains(index) && (wall || block < 12)) map.set_label(index, label);
        }
      }
    }
  }
  return map;
}

TEST(PanoramaViewPredictor, FitnessIsThePlainOneWithinTheSamplingError) {
  std::mt19937 random(5);
  double sum = 0.0;
  double largest = 0.0;
  int views = 0;
  for (int round = 0; round < 30; ++round) {
    const VoxelMap map = room(random);
    const KnownSpace space(map);
    PlainViewPredictor plain(paper_raster(), kVoxelSize, icosahedron_orientations(1), false);
    PanoramaViewPredictor panorama(paper_raster(), kVoxelSize, icosahedron_orientations(1), false);
    PanoramaViewPredictor by_two(paper_raster(), kVoxelSize, icosahedron_orientations(1), false, 2);
    std::vector<ViewCounts> expected(80);
    std::vector<ViewCounts> counts(80);
    std::vector<ViewCounts> counts_by_two(80);
    const VoxelIndex sensor(6 + static_cast<int>(random() % 40),
                            6 + static_cast<int>(random() % 32),
                            6 + static_cast<int>(random() % 20));
    plain.predict(space, sensor, expected);
    panorama.predict(space, sensor, counts);
    by_two.predict(space, sensor, counts_by_two);
    EXPECT_TRUE(std::equal(counts.begin(), counts.end(), counts_by_two.begin()));
    for (std::size_t i = 0; i < counts.size(); ++i) {
      EXPECT_EQ(counts[i].occupied + counts[i].occlusion_plane + counts[i].unseen + counts[i].open,
                64 * 30);
      const double error = std::abs(fitness(counts[i]).value - fitness(expected[i]).value);
      sum += error;
      largest = std::max(largest, error);
      ++views;
    }
  }
  ASSERT_EQ(views, 2400);
  EXPECT_LT(sum / views, 0.01);
  EXPECT_LT(largest, 0.08);
  std::printf("fitness differs by %.4f on average, %.4f at most\n", sum / views, largest);
}

// With the rays it says it has the plain predictor counts the same, surfaces and all.
TEST(PanoramaViewPredictor, CountsWhatThePlainOneCountsWithTheSameRays) {
  std::mt19937 random(7);
  const std::vector<Orientation> orientations = icosahedron_orientations(1);
  ViewCounts sum;
  for (int round = 0; round < 12; ++round) {
    VoxelMap map = room(random);
    for_each_voxel(map.window(), [&](const VoxelIndex& voxel) {
      if (map.label(voxel) != Label::Occupied || random() % 8 == 0) return;
      const auto element = [&] { return static_cast<int>(random() % 40000) - 20000; };
      map.surface_at(voxel).normal_sum = {element(), element(), element()};
      map.surface_at(voxel).quality = static_cast<std::uint16_t>(random());
    });
    const KnownSpace space(map, KnownSpace::Surfaces::Keep);
    const PredictionRaster raster = paper_raster(round % 3 == 0 ? 1.5 : 30.0);
    PanoramaViewPredictor panorama(raster, kVoxelSize, orientations, true, 1 + round % 3);
    PlainViewPredictor plain(raster, kVoxelSize, orientations, true, panorama.rays());
    std::vector<ViewCounts> counts(orientations.size());
    std::vector<ViewCounts> expected(orientations.size());
    for (int place = 0; place < 3; ++place) {
      const VoxelIndex sensor(static_cast<int>(random() % 52), static_cast<int>(random() % 44),
                              static_cast<int>(random() % 31));
      plain.predict(space, sensor, expected);
      panorama.predict(space, sensor, counts);
      ASSERT_EQ(counts, expected) << "round " << round << " from " << sensor.transpose();
    }
    for (const ViewCounts& view : counts) {
      sum.occupied += view.occupied;
      sum.open += view.open;
      sum.improved_voxels += view.improved_voxels;
      sum.normals.xx += view.normals.xx;
    }
  }
  EXPECT_GT(sum.occupied, 50'000);
  EXPECT_GT(sum.open, 50'000);
  EXPECT_GT(sum.improved_voxels, 1000);
  EXPECT_GT(sum.normals.xx, 0);
}

TEST(PanoramaViewPredictor, AsksForSurfacesWhenItCountsThem) {
  const VoxelMap map({kVoxelSize, Eigen::Vector3d::Zero()}, {VoxelIndex::Zero(), {8, 8, 8}});
  PanoramaViewPredictor panorama(paper_raster(), kVoxelSize, icosahedron_orientations(), true);
  std::vector<ViewCounts> counts(20);
  EXPECT_THROW(panorama.predict(KnownSpace(map), VoxelIndex(1, 1, 1), counts), std::logic_error);
}

TEST(PanoramaViewPredictor, ManyDirectionsContainTheFew) {
  // The same orientation has the same counts, whatever others are asked for with it.
  std::mt19937 random(6);
  const VoxelMap map = room(random);
  const KnownSpace space(map);
  const std::vector<Orientation> few = icosahedron_orientations();
  std::vector<Orientation> many = icosahedron_orientations(3);
  many.insert(many.end(), few.begin(), few.end());
  PanoramaViewPredictor predict_few(paper_raster(), kVoxelSize, few, false);
  PanoramaViewPredictor predict_many(paper_raster(), kVoxelSize, many, false);
  std::vector<ViewCounts> counts_few(few.size());
  std::vector<ViewCounts> counts_many(many.size());
  predict_few.predict(space, VoxelIndex(20, 20, 15), counts_few);
  predict_many.predict(space, VoxelIndex(20, 20, 15), counts_many);
  EXPECT_TRUE(std::equal(counts_few.begin(), counts_few.end(), counts_many.end() - 20));
}

TEST(PanoramaViewPredictor, RaysEndAtTheSensorsRange) {
  VoxelMap map({kVoxelSize, Eigen::Vector3d::Zero()}, {VoxelIndex::Zero(), {60, 60, 60}});
  std::fill(map.labels().begin(), map.labels().end(), Label::Empty);
  for (int k = 0; k < 60; ++k) {
    for (int j = 0; j < 60; ++j) map.set_label({59, j, k}, Label::Occupied);
  }
  const KnownSpace space(map);
  std::vector<ViewCounts> counts(20);
  PanoramaViewPredictor near(paper_raster(2.0), kVoxelSize, icosahedron_orientations(), false);
  near.predict(space, VoxelIndex(30, 30, 30), counts);
  for (const ViewCounts& view : counts) EXPECT_EQ(view.open, 64 * 30);
  PanoramaViewPredictor far(paper_raster(30.0), kVoxelSize, icosahedron_orientations(), false);
  far.predict(space, VoxelIndex(30, 30, 30), counts);
  EXPECT_TRUE(std::any_of(counts.begin(), counts.end(),
                          [](const ViewCounts& view) { return view.occupied > 1000; }));
}

}  // namespace
}  // namespace nextview
