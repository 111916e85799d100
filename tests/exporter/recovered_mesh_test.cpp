#include "exporter/recovered_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "exporter/mesh_simplifier.h"
#include "mapper/map_builder.h"
#include "sensor/sensor_geometry.h"
#include "tests/exporter/surface_checks.h"

namespace nextview {
namespace {

constexpr double kSize_m = 0.1;

VoxelMap cube_of(int side) {
  return VoxelMap({kSize_m, Eigen::Vector3d::Zero()},
                  {VoxelIndex::Zero(), VoxelIndex(side, side, side)});
}

OrientedPoints no_points() { return OrientedPoints({kSize_m, Eigen::Vector3d::Zero()}); }

void expect_sound(const SurfaceMesh& mesh, double least_height) {
  const SurfaceFaults faults = faults_of(mesh, least_height);
  EXPECT_EQ(faults.edges_run_twice, 0);
  EXPECT_EQ(faults.low_triangles, 0);
  EXPECT_EQ(faults.unused_vertices, 0);
}

double volume_m3(const SurfaceMesh& mesh) {
  double volume = 0.0;
  for (const auto& t : mesh.triangles) {
    volume += mesh.vertices_m[t[0]]
                  .cast<double>()
                  .cross(mesh.vertices_m[t[1]].cast<double>())
                  .dot(mesh.vertices_m[t[2]].cast<double>()) /
              6.0;
  }
  return volume;
}

TEST(RecoveredMesh, OfOneVoxelIsAClosedOctahedron) {
  VoxelMap map = cube_of(3);
  for_each_voxel(map.window(), [&](const VoxelIndex& v) { map.set_label(v, Label::Empty); });
  map.set_label({1, 1, 1}, Label::Occupied);
  const SurfaceMesh mesh = recovered_mesh(map, no_points());
  EXPECT_EQ(mesh.vertices_m.size(), 6U);
  EXPECT_EQ(mesh.triangles.size(), 8U);
  EXPECT_TRUE(open_edges(mesh).empty());
  expect_sound(mesh, 0.01 * kSize_m);
  // Wound outwards: its volume, 4/3 of (half a voxel) cubed, is positive.
  EXPECT_NEAR(volume_m3(mesh), 4.0 / 3.0 * std::pow(0.5 * kSize_m, 3), 1e-9);
}

TEST(RecoveredMesh, OfABoardOneVoxelThickShowsBothSides) {
  VoxelMap map = cube_of(5);
  for_each_voxel(map.window(), [&](const VoxelIndex& v) {
    map.set_label(v, v.z() == 2 ? Label::Occupied : Label::Empty);
  });
  const SurfaceMesh mesh = recovered_mesh(map, no_points());
  double up_m2 = 0.0, down_m2 = 0.0;
  for (const auto& triangle : mesh.triangles) {
    const double z = area_vector_m2(mesh, triangle).z();
    (z > 0.0 ? up_m2 : down_m2) += 0.5 * z;
  }
  // 4 x 4 cubes between the 5 x 5 voxel centres, and what hangs over into the unseen outside.
  EXPECT_GE(up_m2, 16 * kSize_m * kSize_m - 1e-9);
  EXPECT_NEAR(up_m2, -down_m2, 1e-9);
}

TEST(RecoveredMesh, FillsAHoleOfOneVoxelAndLeavesTheMapAsItIs) {
  VoxelMap map = cube_of(7);
  for_each_voxel(map.window(), [&](const VoxelIndex& v) {
    map.set_label(v, v.z() < 3 ? Label::Unmarked : v.z() == 3 ? Label::Occupied : Label::Empty);
  });
  const SurfaceMesh whole = recovered_mesh(map, no_points());
  map.set_label({3, 3, 3}, Label::Empty);
  map.set_label({3, 3, 2}, Label::OcclusionPlane);
  const SurfaceMesh filled = recovered_mesh(map, no_points());
  EXPECT_EQ(filled.vertices_m, whole.vertices_m);
  EXPECT_EQ(filled.triangles, whole.triangles);
  EXPECT_EQ(map.label({3, 3, 3}), Label::Empty);
  // Two voxels wide it is a hole.
  map.set_label({4, 3, 3}, Label::Empty);
  map.set_label({4, 3, 2}, Label::OcclusionPlane);
  EXPECT_NE(recovered_mesh(map, no_points()).triangles.size(), whole.triangles.size());
}

TEST(RecoveredMesh, LeavesOutAnUnseenVoxelInFreeSpace) {
  VoxelMap map = cube_of(7);
  for_each_voxel(map.window(), [&](const VoxelIndex& v) {
    map.set_label(v, v.z() < 3 ? Label::Unmarked : v.z() == 3 ? Label::Occupied : Label::Empty);
  });
  const SurfaceMesh without = recovered_mesh(map, no_points());
  map.set_label({3, 3, 4}, Label::OcclusionPlane);
  EXPECT_EQ(recovered_mesh(map, no_points()).triangles, without.triangles);
}

TEST(RecoveredMesh, OfNothingSeenIsNothing) {
  EXPECT_TRUE(recovered_mesh(cube_of(4), no_points()).triangles.empty());
}

/// Worlds of random labels: wound consistently, no flat triangle, and closed wherever an Occupied
/// voxel faces an Empty one.
TEST(RecoveredMesh, IsClosedWhereTheSurfaceWasSeenInRandomWorlds) {
  std::mt19937 random(1);
  int open_ends = 0, triangles = 0;
  for (int world = 0; world < 300; ++world) {
    VoxelMap map = cube_of(7);
    const unsigned empty_of_8 = 1 + static_cast<unsigned>(world % 6);
    for_each_voxel(map.window(), [&](const VoxelIndex& v) {
      const unsigned draw = static_cast<unsigned>(random() % 8);
      map.set_label(v, draw < empty_of_8   ? Label::Empty
                       : draw % 2 == 0     ? Label::Occupied
                       : random() % 2 == 0 ? Label::OcclusionPlane
                                           : Label::Unmarked);
    });
    const SurfaceMesh mesh = recovered_mesh(map, no_points());
    expect_sound(mesh, 0.01 * kSize_m);
    triangles += static_cast<int>(mesh.triangles.size());
    for (const auto& [from, to] : open_edges(mesh)) {
      for (const std::uint32_t vertex : {from, to}) {
        ++open_ends;
        // Unmoved, a vertex lies half way between two voxels.
        const Eigen::Vector3d at = mesh.vertices_m[vertex].cast<double>() / kSize_m;
        const VoxelIndex below = (at.array() + 1e-4).floor().cast<int>();
        const VoxelIndex above = (at.array() - 1e-4).ceil().cast<int>();
        ASSERT_EQ((above - below).cwiseAbs().sum(), 1);
        EXPECT_NE(map.label(below), Label::Occupied);
        EXPECT_NE(map.label(above), Label::Occupied);
      }
    }
  }
  EXPECT_GT(open_ends, 10000);
  EXPECT_GT(triangles, 50000);
}

/// A range image of a plane.
RangeImage image_of_plane(const Eigen::Vector3d& normal, double offset_m,
                          const Eigen::Vector3d& position_m, double pan_rad, double tilt_rad) {
  RangeImage image;
  image.pose = {position_m, pan_rad, tilt_rad};
  image.position_m = position_m;
  image.world_from_sensor = world_from_sensor_rotation(pan_rad, tilt_rad);
  image.rays = make_ray_table(TiltedLineScan::with_aperture(96, 96, 1.0));
  for (int v = 0; v < image.rays.rows(); ++v) {
    for (int u = 0; u < image.rays.columns(); ++u) {
      const Eigen::Vector3d ray = image.world_from_sensor * image.rays.ray(u, v);
      const double range_m = (offset_m - normal.dot(position_m)) / normal.dot(ray);
      image.range_m.push_back(range_m > 0.0 ? quantise_range(range_m)
                                            : std::numeric_limits<float>::infinity());
    }
  }
  return image;
}

/// Whatever the slope and wherever the wall lies among the voxels, the mesh of a wall is the wall.
TEST(RecoveredMesh, OfASlantedWallLiesOnTheWall) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int wall = 0; wall < 20; ++wall) {
    const Eigen::Vector3d normal =
        Eigen::Vector3d(0.5 * any(random), -1.0, 0.5 * any(random)).normalized();
    const Eigen::Vector3d sensor(2.0, 0.6, 1.5);
    const Eigen::Vector3d middle(2.0, 2.0 + 0.2 * any(random), 1.5);
    const double offset_m = normal.dot(middle);
    const RangeImage image = image_of_plane(normal, offset_m, sensor, 0.0, 0.0);
    MapBuilder builder({kSize_m, Eigen::Vector3d::Zero()},
                       {VoxelIndex::Zero(), VoxelIndex(40, 40, 30)});
    builder.fold(image);
    OrientedPoints points(builder.map().grid());
    points.add(image);
    const SurfaceMesh mesh = recovered_mesh(builder.map(), points);
    ASSERT_GT(mesh.triangles.size(), 200U);
    expect_sound(mesh, 0.01 * kSize_m);
    // Away from the rim, where what lies behind Empty was never seen.
    const auto is_inner = [&](std::uint32_t vertex) {
      return (mesh.vertices_m[vertex].cast<double>() - middle).norm() < 0.5;
    };
    int inner = 0;
    for (const auto& triangle : mesh.triangles) {
      if (!std::all_of(triangle.begin(), triangle.end(), is_inner)) continue;
      ++inner;
      EXPECT_GT(area_vector_m2(mesh, triangle).dot(normal), 0.0) << "wound towards the sensor";
      for (const std::uint32_t vertex : triangle) {
        EXPECT_NEAR(normal.dot(mesh.vertices_m[vertex].cast<double>()), offset_m, 0.02 * kSize_m);
      }
    }
    EXPECT_GT(inner, 100);
  }
}

/// Points that contradict the map spoil no triangle.
TEST(RecoveredMesh, StaysSoundWhateverThePointsSay) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int world = 0; world < 50; ++world) {
    VoxelMap map = cube_of(16);
    for_each_voxel(map.window(), [&](const VoxelIndex& v) {
      map.set_label(v, random() % 3 == 0 ? Label::Occupied : Label::Empty);
    });
    OrientedPoints points(map.grid());
    for (int n = 0; n < 3; ++n) {
      const Eigen::Vector3d normal = Eigen::Vector3d(any(random), -1.0, any(random)).normalized();
      points.add(image_of_plane(normal,
                                normal.dot(Eigen::Vector3d(0.8, 0.8 + 0.3 * any(random), 0.8)),
                                {0.8, 0.05, 0.8}, 0.0, 0.0));
    }
    const SurfaceMesh mesh = recovered_mesh(map, points);
    ASSERT_GT(mesh.triangles.size(), 1000U);
    expect_sound(mesh, 0.01 * kSize_m);
  }
}

/// A closed ball of voxels.
SurfaceMesh ball() {
  VoxelMap map = cube_of(24);
  for_each_voxel(map.window(), [&](const VoxelIndex& v) {
    const double radius = (v.cast<double>() - Eigen::Vector3d::Constant(11.5)).norm();
    map.set_label(v, radius < 9.0 ? Label::Occupied : Label::Empty);
  });
  return recovered_mesh(map, no_points());
}

TEST(SimplifiedMesh, StaysClosedAndSound) {
  const SurfaceMesh given = ball();
  ASSERT_TRUE(open_edges(given).empty());
  for (const std::size_t wanted : {2000UL, 500UL, 100UL}) {
    const SurfaceMesh mesh = simplified(given, {wanted, {}});
    EXPECT_LE(mesh.triangles.size(), wanted);
    EXPECT_GT(mesh.triangles.size(), wanted / 2);
    EXPECT_TRUE(open_edges(mesh).empty());
    expect_sound(mesh, 1e-6);
    EXPECT_NEAR(volume_m3(mesh), volume_m3(given), 0.1 * volume_m3(given));
  }
}

TEST(SimplifiedMesh, KeepsToTheErrorAskedFor) {
  const SurfaceMesh given = ball();
  const SurfaceMesh mesh = simplified(given, {{}, 0.02});
  EXPECT_LT(mesh.triangles.size(), given.triangles.size() / 2);
  for (const Eigen::Vector3f& vertex : mesh.vertices_m) {
    EXPECT_NEAR((vertex.cast<double>() - Eigen::Vector3d::Constant(1.15)).norm(), 0.9, 0.08);
  }
  EXPECT_EQ(simplified(given, {}).triangles, given.triangles) << "nothing was asked for";
  EXPECT_THROW(simplified(given, {{}, -1.0}), std::invalid_argument);
  EXPECT_TRUE(simplified({}, {10, {}}).triangles.empty());
}

}  // namespace
}  // namespace nextview
