#include "planner/prediction/surface_gain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <set>
#include <vector>

#include "mapper/integer_line.h"
#include "planner/prediction/grown_surface.h"
#include "sensor/sensor_pose.h"
#include "tests/planner/prediction/plain_gain.h"

namespace nextview {
namespace {

using Eigen::Vector3d;

constexpr double kVoxel_m = 0.1;

PredictionRaster raster() { return prediction_raster(TiltedLineScan::paper(), RangeLimits()); }

void fill(VoxelMap& map, const VoxelIndex& min, const VoxelIndex& end, Label label) {
  for (int k = min[2]; k < end[2]; ++k) {
    for (int j = min[1]; j < end[1]; ++j) {
      for (int i = min[0]; i < end[0]; ++i) map.set_label({i, j, k}, label);
    }
  }
}

void set_surface(VoxelMap& map, const VoxelIndex& voxel, const Vector3d& normal, double quality) {
  map.set_label(voxel, Label::Occupied);
  SurfaceVoxel& surface = map.surface_at(voxel);
  for (int axis = 0; axis < 3; ++axis) {
    surface.normal_sum[static_cast<std::size_t>(axis)] =
        std::lround(normal[axis] * SurfaceVoxel::kNormalUnit);
  }
  surface.normal_count = 1;
  surface.quality = static_cast<std::uint16_t>(quality * SurfaceVoxel::kQualityUnit);
}

// A sensor sees a cell when one of its rays is as near as its neighbours are to each other.
TEST(PanoramaViews, AreTheCellsThatHaveARayOfTheSensorNearby) {
  const SensorGeometry sensors[] = {
      TiltedLineScan::paper(), SphericalScanner{64, 32, 2.0 * std::numbers::pi, 1.745},
      SphericalScanner{64, 32, 3.6, 1.745}, LineStriper{64, 32, 1.2, 0.9, 0.1}};
  const std::vector<Orientation> orientations = icosahedron_orientations();
  for (const SensorGeometry& sensor : sensors) {
    const RayTable rays = make_ray_table(sensor);
    const PanoramaViews views(rays, orientations);
    double spacing = 0.0;
    for (int v = 0; v + 1 < rays.rows(); ++v) {
      for (int u = 0; u + 1 < rays.columns(); ++u) {
        spacing = std::max({spacing, std::acos(rays.ray(u, v).dot(rays.ray(u + 1, v))),
                            std::acos(rays.ray(u, v).dot(rays.ray(u, v + 1)))});
      }
    }
    for (const std::size_t view : {0u, 7u, 13u}) {
      const Eigen::Matrix3d rotation =
          world_from_sensor_rotation(orientations[view].pan_rad, orientations[view].tilt_rad);
      std::vector<bool> sees(Panorama::kCells, false);
      views.for_each_cell(view, [&](int cell) { sees[static_cast<std::size_t>(cell)] = true; });
      std::vector<Vector3d> directions;
      for (int v = 0; v < rays.rows(); ++v) {
        for (int u = 0; u < rays.columns(); ++u) directions.push_back(rotation * rays.ray(u, v));
      }
      int different = 0;
      int looked_at = 0;
      for (int cell = 0; cell < Panorama::kCells; cell += 23, ++looked_at) {
        double nearest = -1.0;
        const Vector3d middle = Panorama::direction(cell);
        for (const Vector3d& direction : directions) {
          nearest = std::max(nearest, middle.dot(direction));
        }
        const double angle = std::acos(std::min(nearest, 1.0));
        const bool is_seen = sees[static_cast<std::size_t>(cell)];
        different += is_seen ? angle > 0.75 * spacing : angle < 0.25 * spacing;
      }
      // Those by the rim.
      EXPECT_LE(different, looked_at / 200) << "kind " << sensor.index();
      EXPECT_GT(views.cells(view), 500);
    }
  }
}

TEST(SurfaceGain, IsThatOfTheDefinition) {
  std::mt19937 random(3);
  const std::vector<Orientation> orientations = icosahedron_orientations(1);
  SurfaceGain gain(raster(), kVoxel_m, orientations, {.unknown_weight = 0.3});
  const PanoramaViews views(raster().rays, orientations);
  std::vector<std::vector<int>> cells(orientations.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    views.for_each_cell(i, [&](int cell) { cells[i].push_back(cell); });
    ASSERT_EQ(static_cast<int>(cells[i].size()), views.cells(i));
  }
  int compared = 0;
  for (int round = 0; round < 12; ++round) {
    VoxelMap map({kVoxel_m, Vector3d::Zero()}, {VoxelIndex::Zero(), VoxelIndex(30, 26, 20)});
    fill(map, {2, 2, 2}, {28, 24, 18}, Label::Empty);
    for (int i = 0; i < 150; ++i) {
      const VoxelIndex voxel(static_cast<int>(random() % 30), static_cast<int>(random() % 26),
                             static_cast<int>(random() % 20));
      if (random() % 2 == 0) {
        const Vector3d normal = Vector3d::Unit(static_cast<int>(random() % 3));
        set_surface(map, voxel, normal, 0.5);
      } else {
        map.set_label(voxel, random() % 2 == 0 ? Label::Occluded : Label::OcclusionPlane);
      }
    }
    const VoxelIndex sensor(15, 13, 10);
    map.set_label(sensor, Label::Empty);
    const FreeSpaceField field(map);
    const GrownSurface grown(map);
    ASSERT_GT(grown.size(), 0u);
    std::vector<std::uint8_t> in_vain(field.size(), 0);
    for (std::uint8_t& vain : in_vain) vain = static_cast<std::uint8_t>(random() % 3);
    const SurfaceGain::Known known{field, in_vain, &grown};
    gain.look_from(known, sensor);
    const PlainGain plain(map, field, in_vain, grown, sensor, prediction_reach(raster(), kVoxel_m),
                          0.3);
    double best = 0.0;
    for (std::size_t i = 0; i < orientations.size(); ++i) {
      const ExpectedView expected = plain.view(cells[i]);
      const ExpectedView view = gain.view(i);
      // Each cell's part is rounded down to 1/65536.
      EXPECT_NEAR(view.new_voxels, expected.new_voxels, 2.0 * 2048 / SurfaceGain::kUnit);
      EXPECT_NEAR(view.overlap, expected.overlap, 1e-9);
      if (view.overlap >= 0.2) best = std::max(best, view.new_voxels);
      ++compared;
    }
    EXPECT_EQ(gain.best().new_voxels, best);
  }
  EXPECT_GT(compared, 900);
}

// Looks again and again from some positions while a room becomes known, and each time as if for the
// first time: nothing may be different.
TEST(SurfaceGain, LookingAgainShowsWhatLookingAnewDoes) {
  std::mt19937 random(11);
  const auto below = [&](int size) {
    return static_cast<int>(random() % static_cast<unsigned>(size));
  };
  const std::vector<Orientation> orientations = icosahedron_orientations(1);
  SurfaceGain again(raster(), kVoxel_m, orientations, {});
  SurfaceGain anew(raster(), kVoxel_m, orientations, {});
  VoxelMap map({kVoxel_m, Vector3d::Zero()}, {VoxelIndex::Zero(), VoxelIndex(30, 26, 20)});
  fill(map, {12, 10, 8}, {18, 16, 12}, Label::Empty);
  const std::vector<VoxelIndex> sensors = {{15, 13, 10}, {13, 11, 9}, {17, 15, 11}};
  std::vector<Panorama::Packets> finished(sensors.size(), Panorama::Packets{});
  FreeSpaceField field(map);
  GrownSurface grown(map);
  const std::vector<std::uint8_t> in_vain(field.size(), 0);
  int finished_packets = 0;
  std::size_t bridges = 0;
  for (int round = 0; round < 60; ++round) {
    std::set<std::uint32_t> changed;
    const auto learn = [&](const VoxelIndex& voxel) {
      const bool is_wall = (voxel.array() == 2).any() || voxel[0] == 27 || voxel[1] == 23 ||
                           voxel[2] == 17 || (voxel - VoxelIndex(8, 20, 6)).squaredNorm() < 6;
      const Label before = map.label(voxel);
      if (before == Label::Occupied) return;
      if (is_wall) {
        set_surface(map, voxel, Vector3d::Unit(below(3)), 0.5);
      } else {
        map.set_label(voxel, Label::Empty);
      }
      if (map.label(voxel) != before) changed.insert(static_cast<std::uint32_t>(map.slot(voxel)));
    };
    for (int box = 0; box < 3; ++box) {
      const VoxelIndex min(below(22), below(18), below(12));
      for (int i = 0; i < 512; ++i) learn(min + VoxelIndex(i % 8, i / 8 % 8, i / 64));
    }
    const std::vector<std::uint32_t> slots(changed.begin(), changed.end());
    field.update(map, slots);
    grown.update(map, slots);
    bridges += grown.bridges().size();
    const SurfaceGain::Known known{field, in_vain, &grown};
    for (std::size_t i = 0; i < sensors.size(); ++i) {
      again.look_again(known, sensors[i], finished[i]);
      anew.look_from(known, sensors[i]);
      for (const std::uint64_t word : finished[i]) finished_packets += std::popcount(word);
      for (std::size_t view = 0; view < orientations.size(); ++view) {
        ASSERT_EQ(again.view(view).new_voxels, anew.view(view).new_voxels) << round;
        ASSERT_EQ(again.view(view).overlap, anew.view(view).overlap) << round;
        ASSERT_EQ(again.aimed_at(view), anew.aimed_at(view)) << round;
      }
    }
  }
  EXPECT_GT(finished_packets, 1000);
  EXPECT_GT(bridges, 100u);
}

TEST(Panorama, KnowsWhichRaysMayPassAVoxel) {
  std::mt19937 random(7);
  const auto coordinate = [&] { return static_cast<int>(random() % 31) - 15; };
  std::vector<IntegerLine> lines;
  for (int cell = 0; cell < Panorama::kCells; ++cell) {
    lines.push_back(line_along(VoxelIndex::Zero(), Panorama::direction(cell), 40.0));
  }
  int passing = 0;
  int marked = 0;
  for (int round = 0; round < 200; ++round) {
    const VoxelIndex step(coordinate(), coordinate(), coordinate());
    if (step.isZero()) continue;
    Panorama::Packets packets{};
    Panorama::add_passing(step, packets);
    for (const std::uint64_t word : packets) marked += std::popcount(word);
    for (std::size_t cell = 0; cell < lines.size(); ++cell) {
      const int k = step.cwiseAbs().maxCoeff();
      bool passes = false;
      for (int at = k - 1; at <= k + 1; ++at) passes |= at > 0 && lines[cell].at(at) == step;
      if (!passes) continue;
      ++passing;
      const std::size_t packet = cell / Panorama::kPacketCells;
      ASSERT_EQ(packets[packet / 64] >> packet % 64 & 1, 1u) << step.transpose() << ", " << cell;
    }
  }
  EXPECT_GT(passing, 1000);
  EXPECT_LT(marked, 200 * 60);
}

TEST(SurfaceGain, AVoxelThatFillsTheViewIsOneVoxel) {
  VoxelMap map({kVoxel_m, Vector3d::Zero()}, {VoxelIndex::Zero(), VoxelIndex(31, 31, 31)});
  fill(map, {0, 0, 0}, {31, 31, 31}, Label::Empty);
  fill(map, {0, 25, 0}, {31, 26, 31}, Label::Occupied);  // something to overlap with
  map.set_label({15, 16, 15}, Label::Occluded);          // right before the sensor
  const FreeSpaceField field(map);
  std::vector<std::uint8_t> in_vain(field.size(), 0);
  SurfaceGain gain(raster(), kVoxel_m, icosahedron_orientations(2),
                   {.unknown_weight = 1.0, .min_overlap = 0.0});
  const SurfaceGain::Known known{field, in_vain};
  gain.look_from(known, {15, 15, 15});
  // The next voxel is 53 degrees wide and all of it can be seen across, if not upwards.
  EXPECT_GT(gain.best().new_voxels, 0.5);
  EXPECT_LE(gain.best().new_voxels, 1.0);
  const double before = gain.best().new_voxels;
  const auto offset = static_cast<std::uint32_t>(field.offset({15, 16, 15}));
  EXPECT_EQ(gain.aimed_at(gain.best().orientation), std::vector<std::uint32_t>{offset});
  in_vain[offset] = 1;  // a view was to show it, and did not
  gain.look_from(known, {15, 15, 15});
  EXPECT_NEAR(gain.best().new_voxels, 0.5 * before, 0.02);
}

TEST(SurfaceGain, WithoutOverlapAViewDoesNotCount) {
  VoxelMap map({kVoxel_m, Vector3d::Zero()}, {VoxelIndex::Zero(), VoxelIndex(31, 31, 31)});
  fill(map, {3, 3, 3}, {28, 28, 28}, Label::Empty);  // nothing Occupied anywhere
  const FreeSpaceField field(map);
  const std::vector<std::uint8_t> in_vain(field.size(), 0);
  SurfaceGain gain(raster(), kVoxel_m, icosahedron_orientations(), {.min_overlap = 0.2});
  gain.look_from({field, in_vain}, {15, 15, 15});
  EXPECT_GT(gain.view(0).new_voxels, 1.0);
  EXPECT_EQ(gain.best().new_voxels, 0.0);
}

TEST(SurfaceGain, PoorQualityCanBeImproved) {
  VoxelMap map({kVoxel_m, Vector3d::Zero()}, {VoxelIndex::Zero(), VoxelIndex(31, 31, 31)});
  fill(map, {0, 0, 0}, {31, 31, 31}, Label::Empty);
  set_surface(map, {15, 25, 15}, -Vector3d::UnitY(), 0.4);
  const FreeSpaceField field(map);
  SurfaceTable surfaces;
  const auto slot = static_cast<std::uint32_t>(map.slot({15, 25, 15}));
  surfaces.update(map, field, {&slot, 1});
  const std::vector<std::uint8_t> in_vain(field.size(), 0);
  SurfaceGain gain(raster(), kVoxel_m, icosahedron_orientations(2),
                   {.unknown_weight = 1.0, .improvement_weight = 0.3, .min_overlap = 0.0});
  gain.look_from({field, in_vain, nullptr, &surfaces}, {15, 15, 15});  // head on
  EXPECT_NEAR(gain.best().improvement, 0.6, 0.02);
  EXPECT_EQ(gain.best().new_voxels, 0.0);
  EXPECT_NEAR(gain.best().value(0.3), 0.18, 0.01);
}

TEST(GrownSurface, GoesOnInItsPlaneIntoTheUnknown) {
  VoxelMap map({kVoxel_m, Vector3d::Zero()}, {VoxelIndex::Zero(), VoxelIndex(60, 21, 21)});
  fill(map, {0, 0, 11}, {10, 21, 21}, Label::Empty);
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 21; ++j) set_surface(map, {i, j, 10}, Vector3d::UnitZ(), 1.0);
  }
  const FreeSpaceField field(map);
  const GrownSurface grown(map);
  const auto likelihood = [&](int i, int k) {
    return static_cast<double>(grown.likelihood(field.offset({i, 10, k}))) / GrownSurface::kCertain;
  };
  EXPECT_NEAR(likelihood(10, 10), std::exp(-0.1 / 2.0), 1e-3);
  EXPECT_NEAR(likelihood(19, 10), std::exp(-1.0 / 2.0), 1e-3);
  EXPECT_GT(likelihood(48, 10), 0.1);
  EXPECT_EQ(likelihood(50, 10), 0.0);  // more than 4 m away
  EXPECT_EQ(likelihood(15, 11), 0.0);
  EXPECT_EQ(likelihood(15, 9), 0.0);
  EXPECT_EQ(likelihood(5, 10), 0.0);  // known
}

TEST(GrownSurface, EndsAtSurfacesAndBridgesTwoEmptyVoxels) {
  VoxelMap map({kVoxel_m, Vector3d::Zero()}, {VoxelIndex::Zero(), VoxelIndex(60, 3, 3)});
  set_surface(map, {5, 1, 1}, Vector3d::UnitZ(), 1.0);
  fill(map, {8, 0, 1}, {10, 3, 2}, Label::Empty);
  fill(map, {20, 0, 1}, {23, 3, 2}, Label::Empty);
  fill(map, {0, 0, 1}, {3, 3, 2}, Label::Occupied);  // without normals
  const FreeSpaceField field(map);
  const GrownSurface grown(map);
  const auto likelihood = [&](int i) { return grown.likelihood(field.offset({i, 1, 1})); };
  EXPECT_GT(likelihood(7), 0);
  EXPECT_GT(likelihood(8), 0);  // Empty, unknown behind
  EXPECT_LT(likelihood(8), likelihood(10));
  EXPECT_GT(likelihood(19), 0);
  EXPECT_EQ(likelihood(20), 0);  // three Empty voxels
  EXPECT_EQ(likelihood(25), 0);
  EXPECT_GT(likelihood(3), 0);
  EXPECT_EQ(likelihood(2), 0);
}

TEST(GrownSurface, FollowsTheMapAsIfMadeAnew) {
  std::mt19937 random(5);
  // So small that everything is in reach of everything.
  VoxelMap map({kVoxel_m, Vector3d::Zero()}, {VoxelIndex::Zero(), VoxelIndex(20, 18, 16)});
  GrownSurface followed(map);
  std::size_t grown = 0;
  for (int round = 0; round < 30; ++round) {
    std::set<std::uint32_t> changed;
    for (int i = 0; i < 40; ++i) {
      const VoxelIndex voxel(static_cast<int>(random() % 20), static_cast<int>(random() % 18),
                             static_cast<int>(random() % 16));
      if (map.label(voxel) == Label::Occupied) continue;
      if (random() % 8 == 0) {
        set_surface(map, voxel, Vector3d::Unit(static_cast<int>(random() % 3)), 1.0);
      } else {
        map.set_label(voxel, Label::Empty);
      }
      changed.insert(static_cast<std::uint32_t>(map.slot(voxel)));
    }
    followed.update(map, std::vector<std::uint32_t>(changed.begin(), changed.end()));
    const GrownSurface anew(map);
    for (std::size_t offset = 0; offset < anew.field().size(); ++offset) {
      ASSERT_EQ(followed.likelihood(offset), anew.likelihood(offset));
    }
    for (int v = 0; v < 20 * 18 * 16; ++v) {
      const VoxelIndex voxel(v % 20, v / 20 % 18, v / 360);
      ASSERT_EQ(followed.field().at(voxel), anew.field().at(voxel));
    }
    grown += anew.size();
  }
  EXPECT_GT(grown, 1000u);
}

}  // namespace
}  // namespace nextview
