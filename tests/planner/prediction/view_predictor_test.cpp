#include "planner/prediction/view_predictor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "planner/fitness.h"
#include "sensor/sensor_pose.h"

namespace nextview {
namespace {

constexpr double kPi = std::numbers::pi;

// Rays 45 degrees to the left, straight ahead and 45 degrees to the right, in one row.
RayTable three_rays() {
  const double s = std::sqrt(0.5);
  return {{s, 0.0, -s}, {s, 1.0, s}, {0.0}, {1.0}};
}

std::vector<Orientation> looking(std::initializer_list<double> pans_rad) {
  std::vector<Orientation> orientations;
  for (const double pan_rad : pans_rad) {
    orientations.push_back({pan_rad, 0.0, viewing_direction(pan_rad, 0.0)});
  }
  return orientations;
}

// 5 x 5 x 5 voxels of 1 m, all Empty; the sensor in the middle of the near side.
class SmallWorld : public ::testing::Test {
 protected:
  SmallWorld() : map({1.0, Eigen::Vector3d::Zero()}, {VoxelIndex::Zero(), VoxelIndex(5, 5, 5)}) {
    for (int k = 0; k < 5; ++k) {
      for (int j = 0; j < 5; ++j) {
        for (int i = 0; i < 5; ++i) map.set_label({i, j, k}, Label::Empty);
      }
    }
  }

  std::vector<ViewCounts> predict(double range_max_m, std::vector<Orientation> orientations,
                                  bool quality = false) {
    PlainViewPredictor predictor({three_rays(), range_max_m}, 1.0, orientations, quality);
    std::vector<ViewCounts> counts(orientations.size());
    predictor.predict(KnownSpace(map), sensor, counts);
    return counts;
  }

  VoxelMap map;
  VoxelIndex sensor{2, 0, 2};
};

TEST_F(SmallWorld, CountsWhatEachRayMeetsFirst) {
  map.set_label({1, 1, 2}, Label::OcclusionPlane);
  map.set_label({2, 2, 2}, Label::Occupied);
  map.set_label({2, 3, 2}, Label::Occluded);  // behind the Occupied one: not met
  map.set_label({3, 1, 2}, Label::Unmarked);
  const ViewCounts counts = predict(30.0, looking({0.0}))[0];
  EXPECT_EQ(counts, (ViewCounts{1, 1, 1, 0, 0, 0, 0}));
  const Fitness f = fitness(counts);
  EXPECT_NEAR(f.share_occupied, 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(f.value, 5.0 / 27.0 - 10.5 / 9.0 + 2.0, 1e-12);
}

TEST_F(SmallWorld, AnOccludedVoxelThatIsNotAPlaneIsUnseen) {
  map.set_label({2, 1, 2}, Label::Occluded);
  EXPECT_EQ(predict(30.0, looking({0.0}))[0], (ViewCounts{0, 0, 1, 2, 0, 0, 0}));
}

TEST_F(SmallWorld, OrientationsLookWhereTheySay) {
  map.set_label({4, 0, 2}, Label::Occupied);        // to the right
  map.set_label({0, 0, 2}, Label::OcclusionPlane);  // to the left
  const auto counts = predict(30.0, looking({0.0, -kPi / 2.0, kPi / 2.0, kPi}));
  EXPECT_EQ(counts[0], (ViewCounts{0, 0, 0, 3, 0, 0, 0}));
  EXPECT_EQ(counts[1], (ViewCounts{1, 0, 0, 2, 0, 0, 0}));
  EXPECT_EQ(counts[2], (ViewCounts{0, 1, 0, 2, 0, 0, 0}));
  EXPECT_EQ(counts[3], (ViewCounts{0, 0, 0, 3, 0, 0, 0}));  // out of the window at once
}

TEST_F(SmallWorld, RaysEndAtTheWindow) { EXPECT_EQ(predict(1000.0, looking({0.0}))[0].open, 3); }

TEST_F(SmallWorld, RaysEndAtTheSensorsRange) {
  map.set_label({2, 3, 2}, Label::Occupied);
  EXPECT_EQ(predict(2.0, looking({0.0}))[0], (ViewCounts{0, 0, 0, 3, 0, 0, 0}));
  EXPECT_EQ(predict(3.0, looking({0.0}))[0], (ViewCounts{1, 0, 0, 2, 0, 0, 0}));
}

TEST_F(SmallWorld, TheSensorsOwnVoxelDoesNotCount) {
  map.set_label(sensor, Label::Occupied);
  EXPECT_EQ(predict(30.0, looking({0.0}))[0].open, 3);
}

// Head-on the wall voxel's quality can rise from 0.2 to 1; the left ray sees its neighbour, whose
// normal stands at 45 degrees to it, no better than before; the right one has no normal.
TEST_F(SmallWorld, CountsTheVoxelsThatWouldImprove) {
  const int one = SurfaceVoxel::kNormalUnit;
  map.set_label({2, 2, 2}, Label::Occupied);
  map.surface_at({2, 2, 2}) = {{0, -3 * one, 0}, 3, 13107};
  map.set_label({0, 2, 2}, Label::Occupied);
  map.surface_at({0, 2, 2}) = {{0, -one, 0}, 1, 46342};
  map.set_label({4, 2, 2}, Label::Occupied);
  const ViewCounts counts = predict(30.0, looking({0.0}), true)[0];
  const NormalScatter two_ahead{.yy = 2 * one * one};
  EXPECT_EQ(counts, (ViewCounts{3, 0, 0, 0, 3, 1, 65535 - 13107, two_ahead}));
  EXPECT_EQ(predict(30.0, looking({0.0}), false)[0], (ViewCounts{3, 0, 0, 0, 0, 0, 0}));
}

// The left voxel's normal is (1, -1, 0) / sqrt 2, the one ahead's (0, -0.6, 0.8).
TEST_F(SmallWorld, SumsTheNormalsOfTheVoxelsItMeets) {
  map.set_label({2, 2, 2}, Label::Occupied);
  map.surface_at({2, 2, 2}).normal_sum = {0, -600, 800};
  map.set_label({0, 2, 2}, Label::Occupied);
  map.surface_at({0, 2, 2}).normal_sum = {70, -70, 0};
  const NormalScatter normals = predict(30.0, looking({0.0}), true)[0].normals;
  const auto near = [](std::int64_t sum, double expected) {
    EXPECT_NEAR(static_cast<double>(sum) / (1 << 28), expected, 1e-4);
  };
  near(normals.xx, 0.5);
  near(normals.yy, 0.5 + 0.36);
  near(normals.zz, 0.64);
  near(normals.xy, -0.5);
  near(normals.xz, 0.0);
  near(normals.yz, -0.48);
}

TEST_F(SmallWorld, AVoxelMetByManyRaysCountsOnceWithItsBestRay) {
  map.set_label({2, 1, 2}, Label::Occupied);
  map.surface_at({2, 1, 2}) = {{0, -SurfaceVoxel::kNormalUnit, 0}, 1, 60000};
  // Rays so close together that all three end in the voxel ahead.
  const RayTable narrow{{0.1, 0.0, -0.1}, {std::sqrt(0.99), 1.0, std::sqrt(0.99)}, {0.0}, {1.0}};
  PlainViewPredictor predictor({narrow, 2.0}, 1.0, looking({0.0}), true);
  ViewCounts counts;
  predictor.predict(KnownSpace(map), sensor, {&counts, 1});
  const NormalScatter one_ahead{.yy = 1 << 28};
  EXPECT_EQ(counts, (ViewCounts{3, 0, 0, 0, 1, 1, 65535 - 60000, one_ahead}));
}

TEST_F(SmallWorld, RefusesWhatItWasNotMadeFor) {
  PlainViewPredictor predictor({three_rays(), 2.0}, 1.0, looking({0.0, 1.0}), false);
  std::vector<ViewCounts> counts(2);
  EXPECT_THROW(predictor.predict(KnownSpace(map), {2, 5, 2}, counts), std::invalid_argument);
  EXPECT_THROW(predictor.predict(KnownSpace(map), sensor, {counts.data(), 1}),
               std::invalid_argument);
  const VoxelMap finer({0.5, Eigen::Vector3d::Zero()}, map.window());
  EXPECT_THROW(predictor.predict(KnownSpace(finer), sensor, counts), std::invalid_argument);
  EXPECT_THROW(PlainViewPredictor({three_rays(), 2.0}, 1.0, {}, false), std::invalid_argument);
  const std::vector<Eigen::Vector3d> two_rays(2, Eigen::Vector3d::UnitY());
  EXPECT_THROW(PlainViewPredictor({three_rays(), 2.0}, 1.0, looking({0.0}), false, two_rays),
               std::invalid_argument);
  EXPECT_THROW(PlainViewPredictor({three_rays(), 0.0}, 1.0, looking({0.0}), false),
               std::invalid_argument);
}

TEST(PredictedQuality, IsTheCosineInIntegers) {
  const QuantisedDirection ahead = quantise_direction(Eigen::Vector3d::UnitY());
  EXPECT_EQ(ahead, (QuantisedDirection{0, 16384, 0}));
  EXPECT_EQ(quantised_cosine(ahead, ahead), 1 << 28);
  EXPECT_EQ(predicted_quality(1 << 28), 65535);
  EXPECT_EQ(predicted_quality((1 << 28) + 20000), 65535);  // rounded vectors can be too long
  EXPECT_EQ(predicted_quality(1 << 27), 32768);
  EXPECT_EQ(predicted_quality(0), 0);
  const QuantisedDirection back = quantise_direction(-Eigen::Vector3d::UnitY());
  EXPECT_EQ(quantised_cosine(ahead, back), 1 << 28);
}

TEST(PredictionRaster, IsTheSensorsOwnUpTo64By32) {
  const PredictionRaster own = prediction_raster(TiltedLineScan::paper(), {});
  EXPECT_EQ(own.rays.columns(), 64);
  EXPECT_EQ(own.rays.rows(), 30);
  const TiltedLineScan large = TiltedLineScan::with_aperture(512, 256, kPi / 3.0);
  const PredictionRaster fewer = prediction_raster(large, {0.05, 12.0});
  EXPECT_EQ(fewer.rays.columns(), 64);
  EXPECT_EQ(fewer.rays.rows(), 32);
  EXPECT_EQ(fewer.range_max_m, 12.0);
  const RayTable all = make_ray_table(large);
  EXPECT_EQ(fewer.rays.ray(0, 0), all.ray(0, 0));
  EXPECT_EQ(fewer.rays.ray(63, 31), all.ray(511, 255));
}

TEST(PredictionRaster, OfAPanoramaIsItsPicture64By32OrWhatIsSaid) {
  const PredictionRaster some = prediction_raster(SphericalScanner{}, {});
  EXPECT_EQ(some.rays.rows(), 64);     // meridians
  EXPECT_EQ(some.rays.columns(), 32);  // pixels of each
  EXPECT_EQ(some.rays.kind, SensorKind::Spherical);
  const PredictionRaster said = prediction_raster(SphericalScanner{}, {}, {20, 10});
  EXPECT_EQ(said.rays.rows(), 20);
  EXPECT_EQ(said.rays.columns(), 10);
  const PredictionRaster own = prediction_raster(TiltedLineScan::paper(), {}, {512, 512});
  EXPECT_EQ(own.rays.pixels(), 64u * 30u) << "no more than the sensor has";
}

}  // namespace
}  // namespace nextview
