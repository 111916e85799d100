#include "planner/prediction/selective_view_predictor.h"

#include <gtest/gtest.h>

#include <memory>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "planner/prediction/fast_view_predictor.h"
#include "planner/prediction/panorama_view_predictor.h"
#include "tests/planner/random_known_room.h"

namespace nextview {
namespace {

constexpr double kVoxel_m = RandomKnownRoom::kVoxel_m;

PredictionRaster raster(double range_max_m) {
  return {make_ray_table(TiltedLineScan::with_aperture(15, 9, std::numbers::pi / 3.0)),
          range_max_m};
}

// Some of 80 orientations in no order, one of them twice.
const std::vector<std::size_t> kSome = {41, 3, 79, 0, 41, 12};

std::vector<ViewCounts> asked(ViewPredictor& predictor, const KnownSpace& space,
                              const VoxelIndex& sensor) {
  std::vector<ViewCounts> counts(kSome.size());
  predictor.look_from(space, sensor);
  predictor.count(kSome, counts);
  return counts;
}

// What they say of all orientations, in the order of those asked for.
std::vector<ViewCounts> of_all(ViewPredictor& predictor, const KnownSpace& space,
                               const VoxelIndex& sensor) {
  std::vector<ViewCounts> all(predictor.orientations().size());
  predictor.predict(space, sensor, all);
  std::vector<ViewCounts> counts;
  for (const std::size_t orientation : kSome) counts.push_back(all[orientation]);
  return counts;
}

TEST(SelectiveViewPredictor, CountsWhatThePlainOneCounts) {
  const std::vector<Orientation> orientations = icosahedron_orientations(1);
  std::int64_t improved = 0;
  std::int64_t open = 0;
  for (int state = 1; state <= 12; ++state) {
    const RandomKnownRoom room(state);
    const KnownSpace space(room.map(), KnownSpace::Surfaces::Keep);
    const VoxelIndex sensor = room.map().grid().voxel_of(room.position_m());
    const PredictionRaster rays = raster(state % 2 == 0 ? 1.3 : 30.0);
    const bool surfaces = state % 3 != 0;
    PlainViewPredictor plain(rays, kVoxel_m, orientations, surfaces);
    SelectiveViewPredictor selective(rays, kVoxel_m, orientations, surfaces, 1 + state % 2);
    const std::vector<ViewCounts> expected = of_all(plain, space, sensor);
    EXPECT_EQ(asked(selective, space, sensor), expected) << "state " << state;
    EXPECT_EQ(selective.tabulated(), 5u);
    EXPECT_EQ(of_all(selective, space, sensor), expected) << "state " << state;
    EXPECT_EQ(selective.tabulated(), 80u);
    for (const ViewCounts& view : expected) {
      improved += view.improved_voxels;
      open += view.open;
    }
  }
  EXPECT_GT(improved, 20);
  EXPECT_GT(open, 100);
}

TEST(ViewPredictor, SaysOfSomeWhatItSaysOfAll) {
  const std::vector<Orientation> orientations = icosahedron_orientations(1);
  for (int state = 1; state <= 4; ++state) {
    const RandomKnownRoom room(state);
    const KnownSpace space(room.map(), KnownSpace::Surfaces::Keep);
    const VoxelIndex sensor = room.map().grid().voxel_of(room.position_m());
    std::vector<std::unique_ptr<ViewPredictor>> predictors;
    predictors.push_back(
        std::make_unique<PlainViewPredictor>(raster(30.0), kVoxel_m, orientations, true));
    predictors.push_back(
        std::make_unique<FastViewPredictor>(raster(30.0), kVoxel_m, orientations, true));
    predictors.push_back(
        std::make_unique<PanoramaViewPredictor>(raster(30.0), kVoxel_m, orientations, true));
    for (const auto& predictor : predictors) {
      EXPECT_EQ(asked(*predictor, space, sensor), of_all(*predictor, space, sensor));
    }
  }
}

TEST(SelectiveViewPredictor, SaysWhatCannotBe) {
  const VoxelMap map({kVoxel_m, Eigen::Vector3d::Zero()}, {VoxelIndex::Zero(), {8, 8, 8}});
  const auto orientations = icosahedron_orientations();
  SelectiveViewPredictor predictor(raster(30.0), kVoxel_m, orientations, true);
  EXPECT_THROW(predictor.look_from(KnownSpace(map), {1, 1, 1}), std::logic_error);
  const KnownSpace space(map, KnownSpace::Surfaces::Keep);
  EXPECT_THROW(predictor.look_from(space, {8, 1, 1}), std::invalid_argument);
  predictor.look_from(space, {1, 1, 1});
  std::vector<ViewCounts> counts(2);
  EXPECT_THROW(predictor.count(kSome, counts), std::invalid_argument);
  EXPECT_THROW(SelectiveViewPredictor(raster(30.0), kVoxel_m, {}, false), std::invalid_argument);
  EXPECT_THROW(SelectiveViewPredictor(raster(30.0), kVoxel_m, orientations, false, 0),
               std::invalid_argument);
}

}  // namespace
}  // namespace nextview
