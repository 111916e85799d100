// What a view of the paper's rooms hides, held against geometry (P12).
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "mapper/map_builder.h"
#include "scene/scene.h"
#include "scene/scene_catalog.h"
#include "sensor_sim/scan.h"

namespace nextview {
namespace {

struct View {
  Scene scene;
  VoxelGrid grid = {0.1, Eigen::Vector3d::Zero()};
  MapWindow window;
  RangeImage image;
};

// The paper's sensor at the scene's start; the window is the room and a voxel around it.
View first_view(const char* name) {
  const SceneDescription description = find_scene(name, NEXTVIEW_SOURCE_DIR "/scenes");
  View view{Scene(load_mesh(description.file, description.options)), {}, {}, {}};
  const Eigen::Vector3d size_m = view.scene.mesh().bounds_m().max();
  view.window.min = VoxelIndex::Constant(-1);
  for (int axis = 0; axis < 3; ++axis) {
    view.window.size[axis] = static_cast<int>(std::lround(10.0 * size_m[axis])) + 3;
  }
  SensorPose pose;
  pose.position_m = description.start_m.value();
  pose.pan_rad = description.start_pan_rad.value_or(0.0);
  RandomStream noise(1, 1, 1, RandomPurpose::RangeNoise);
  view.image =
      scan(view.scene, make_ray_table(TiltedLineScan::paper()), RangeLimits(), pose, 0.0, noise);
  return view;
}

// Whether the sensor looks towards a point, and how far beyond the first surface it lies; below
// zero in front of it.
std::optional<double> depth_behind_surface_m(const View& view, const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d way_m = point_m - view.image.position_m;
  const Eigen::Vector3d in_sensor = view.image.world_from_sensor.transpose() * way_m.normalized();
  const RayTable& rays = view.image.rays;
  const bool in_view =
      in_sensor[1] > 0.0 && std::abs(in_sensor[0]) <= rays.column_sin.front() &&
      std::abs(in_sensor[2]) <= in_sensor[1] * rays.row_sin.front() / rays.row_cos.front();
  if (!in_view) return std::nullopt;
  const auto hit = view.scene.first_hit(view.image.position_m, way_m.normalized());
  if (!hit) return std::nullopt;
  return way_m.norm() - static_cast<double>(hit->distance_m);
}

TEST(HiddenSpace, MostOfWhatOneViewOfBoxesHidesIsOccluded) {
  const View view = first_view("boxes");
  MapBuilder builder(view.grid, view.window);
  builder.fold(view.image);
  int hidden = 0, occluded = 0, in_sight = 0, wrongly_hidden = 0;
  for_each_voxel(view.window, [&](const VoxelIndex& voxel) {
    const auto depth_m = depth_behind_surface_m(view, view.grid.center_m(voxel));
    const Label label = builder.map().label(voxel);
    if (!depth_m || label == Label::Occupied) return;
    const bool is_hidden = label == Label::Occluded || label == Label::OcclusionPlane;
    if (*depth_m > 0.0 && label != Label::Empty) {
      ++hidden;
      occluded += is_hidden;
    } else if (*depth_m < -0.18) {  // a voxel's diagonal before the surface
      ++in_sight;
      wrongly_hidden += is_hidden;
    }
  });
  std::cout << occluded << " of " << hidden << " hidden voxels are Occluded, " << wrongly_hidden
            << " of " << in_sight << " in sight\n";
  EXPECT_GT(hidden, 1000);
  EXPECT_GT(occluded, 0.93 * hidden);
  EXPECT_LT(wrongly_hidden, 0.01 * in_sight);
}

}  // namespace
}  // namespace nextview
