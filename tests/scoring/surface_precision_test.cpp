#include "scoring/surface_precision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <vector>

#include "sensor_sim/scan.h"
#include "tests/scoring/room_mesh.h"

namespace nextview {
namespace {

/// The plain twin: what is left of a triangle when the six half spaces of a box have been cut off.
bool leaves_something(const std::array<Eigen::Vector3d, 3>& corners,
                      const Eigen::AlignedBox3d& box) {
  std::vector<Eigen::Vector3d> polygon(corners.begin(), corners.end());
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const double limit = sign < 0.0 ? -box.min()[axis] : box.max()[axis];
      std::vector<Eigen::Vector3d> rest;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Eigen::Vector3d& a = polygon[i];
        const Eigen::Vector3d& b = polygon[(i + 1) % polygon.size()];
        const double beyond_a = sign * a[axis] - limit;
        const double beyond_b = sign * b[axis] - limit;
        if (beyond_a <= 0.0) rest.push_back(a);
        if ((beyond_a <= 0.0) != (beyond_b <= 0.0)) {
          rest.push_back(a + beyond_a / (beyond_a - beyond_b) * (b - a));
        }
      }
      polygon = rest;
    }
  }
  return !polygon.empty();
}

TEST(TriangleMeetsBox, AsCuttingItDownDoes) {
  RandomStream random(1, 0, 0, RandomPurpose::InitialSimplex);
  const Eigen::AlignedBox3d box(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 2, 3));
  int met = 0;
  constexpr int kCases = 20000;
  for (int i = 0; i < kCases; ++i) {
    const auto corner = [&] { return random_point(random, {-3, -3, -3}, {4, 5, 6}); };
    const std::array<Eigen::Vector3d, 3> triangle = {corner(), corner(), corner()};
    const bool expected = leaves_something(triangle, box);
    ASSERT_EQ(triangle_meets_box(triangle, box), expected) << i;
    met += expected ? 1 : 0;
  }
  EXPECT_GT(met, kCases / 10);
  EXPECT_LT(met, kCases * 9 / 10);
}

TEST(TriangleMeetsBox, TouchingCounts) {
  const Eigen::AlignedBox3d box(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 1, 1));
  const auto at = [](double z) {
    return std::array<Eigen::Vector3d, 3>{Eigen::Vector3d(-9, -9, z), Eigen::Vector3d(9, -9, z),
                                          Eigen::Vector3d(0, 9, z)};
  };
  EXPECT_TRUE(triangle_meets_box(at(1.0), box));
  EXPECT_FALSE(triangle_meets_box(at(1.001), box));
}

/// A square of 1 m at x = 0.52 m, y and z from 0 to 1 m, in a window of 10 cm voxels, of which
/// voxel 5 along x reaches from 0.45 to 0.55 m.
TriangleMesh square() {
  TriangleMesh mesh;
  mesh.vertices_m = {{0.52F, 0, 0}, {0.52F, 1, 0}, {0.52F, 1, 1}, {0.52F, 0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}
const MapWindow kWindow{{0, -3, -3}, {12, 20, 20}};

TEST(NearSurface, IsInAVoxelOrItsTwentySixNeighbours) {
  const NearSurface near(square(), VoxelGrid{}, kWindow);
  for (int x = 0; x < 12; ++x) {
    EXPECT_EQ(near.holds({x, 5, 5}), x >= 4 && x <= 6) << x;
  }
  // The square ends at 1 m, in voxel 10 along y and z; voxel 11 is beside it, also over its corner.
  EXPECT_TRUE(near.holds({5, 11, 5}));
  EXPECT_FALSE(near.holds({5, 12, 5}));
  EXPECT_TRUE(near.holds({6, 11, 11}));
  EXPECT_FALSE(near.holds({6, 11, 12}));
  EXPECT_FALSE(near.holds({5, 5, 99})) << "outside the window";
}

TEST(NearSurface, ASurfaceBetweenTwoVoxelsIsInBoth) {
  TriangleMesh mesh = square();
  for (Eigen::Vector3f& vertex : mesh.vertices_m) vertex.x() = 0.55F;
  const NearSurface near(mesh, VoxelGrid{}, kWindow);
  for (int x = 0; x < 12; ++x) {
    EXPECT_EQ(near.holds({x, 5, 5}), x >= 4 && x <= 7) << x;
  }
}

class Precision : public testing::Test {
 protected:
  FoldReport becomes_occupied(const std::vector<VoxelIndex>& voxels) {
    FoldReport report;
    for (const VoxelIndex& voxel : voxels) {
      map_.set_label(voxel, Label::Occupied);
      report.changed_slots.push_back(static_cast<std::uint32_t>(map_.slot(voxel)));
    }
    return report;
  }

  VoxelMap map_{VoxelGrid{}, kWindow};
  NearSurface near_{square(), VoxelGrid{}, kWindow};
  SurfacePrecision precision_;
};

TEST_F(Precision, IsTheShareOfOccupiedVoxelsWithSurfaceInOrBesideThem) {
  precision_.set_near(map_, near_);
  precision_.add_view(map_, FoldReport{});
  precision_.add_view(map_, becomes_occupied({{5, 5, 5}, {4, 5, 5}}));
  precision_.add_view(map_, becomes_occupied({{3, 5, 5}, {9, 5, 5}}));
  precision_.add_view(map_, becomes_occupied({{6, 6, 6}}));
  EXPECT_EQ(precision_.after_view(1), std::nullopt) << "nothing is Occupied";
  EXPECT_EQ(precision_.after_view(2), 1.0);
  EXPECT_EQ(precision_.after_view(3), 0.5);
  EXPECT_EQ(precision_.after_view(4), 0.6);
  EXPECT_EQ(precision_.after_view(5), std::nullopt);
}

TEST_F(Precision, LeavesOutVoxelsThatChangedToSomethingElse) {
  precision_.set_near(map_, near_);
  FoldReport report = becomes_occupied({{5, 5, 5}});
  map_.set_label({9, 5, 5}, Label::Empty);
  report.changed_slots.push_back(static_cast<std::uint32_t>(map_.slot({9, 5, 5})));
  precision_.add_view(map_, report);
  EXPECT_EQ(precision_.after_view(1), 1.0);
}

TEST_F(Precision, IsTheSameWhenItBecomesKnownLater) {
  precision_.add_view(map_, becomes_occupied({{5, 5, 5}, {9, 5, 5}}));
  precision_.add_view(map_, becomes_occupied({{4, 5, 5}, {6, 5, 5}}));
  EXPECT_EQ(precision_.after_view(1), std::nullopt);
  precision_.set_near(map_, near_);
  EXPECT_EQ(precision_.after_view(1), 0.5);
  EXPECT_EQ(precision_.after_view(2), 0.75);
  precision_.add_view(map_, FoldReport{});
  EXPECT_EQ(precision_.after_view(3), 0.75);
}

/// The precision of the map of some scans of a room of 4 x 3 x 3 m from its middle.
double of_a_room(double range_noise_m) {
  const Scene scene(room({4.0, 3.0, 3.0}));
  const RayTable rays = make_ray_table(TiltedLineScan::paper());
  MapBuilder builder(VoxelGrid{}, {{-10, -10, -10}, {60, 50, 50}});
  SurfacePrecision precision;
  precision.set_near(builder.map(),
                     NearSurface(scene.mesh(), builder.map().grid(), builder.map().window()));
  for (int view = 1; view <= 6; ++view) {
    RandomStream noise(1, view, 1, RandomPurpose::RangeNoise);
    const SensorPose pose{{2.0, 1.5, 1.5}, view * std::numbers::pi / 3.0, 0.0};
    const RangeImage image = scan(scene, rays, RangeLimits(), pose, range_noise_m, noise);
    precision.add_view(builder.map(), builder.fold(image));
  }
  return precision.after_view(6).value();
}

TEST(PrecisionOfARoom, IsOneWithoutNoiseAndFallsWithIt) {
  EXPECT_EQ(of_a_room(0.0), 1.0);
  // A voxel is stray when its point is off by more than a voxel and a half at most: 15 cm are five
  // standard deviations of 3 cm, and a half of one of 30 cm.
  EXPECT_GT(of_a_room(0.03), 0.99);
  const double coarse = of_a_room(0.3);
  EXPECT_LT(coarse, 0.8);
  EXPECT_GT(coarse, 0.2);
}

}  // namespace
}  // namespace nextview
