// Plans views in a program of its own, without bus, scene files or processes: the "robot" stands in
// an empty box of a room whose ranges are worked out here. Put your driver in the place of scan().
#include <algorithm>
#include <cstdio>
#include <memory>
#include <numbers>
#include <variant>

#include "lcmtypes/tell_version.h"
#include "planner/surface_strategy.h"
#include "planner/view_planner.h"
#include "sensor/sensor_geometry.h"

namespace {

const Eigen::Vector3d kRoomMin(0.0, 0.0, 0.0);
const Eigen::Vector3d kRoomMax(6.0, 5.0, 2.8);

// How far it is from inside the room to its walls.
double range_in_room(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
  const Eigen::Array3d to_max = (kRoomMax - from).array() / direction.array();
  const Eigen::Array3d to_min = (kRoomMin - from).array() / direction.array();
  return to_max.max(to_min).minCoeff();
}

nextview::RangeImage scan(const nextview::SensorPose& pose, const nextview::RayTable& rays) {
  nextview::RangeImage image;
  image.pose = pose;
  image.position_m = pose.position_m;
  image.world_from_sensor = nextview::world_from_sensor_rotation(pose.pan_rad, pose.tilt_rad);
  image.rays = rays;
  for (int v = 0; v < rays.rows(); ++v) {
    for (int u = 0; u < rays.columns(); ++u) {
      const double range_m =
          range_in_room(pose.position_m, image.world_from_sensor * rays.ray(u, v));
      image.range_m.push_back(nextview::quantise_range(range_m));
    }
  }
  return image;
}

}  // namespace

int main(int argc, char** argv) {
  if (nextview::tell_version(argc, argv)) return 0;
  const nextview::VoxelGrid grid{.voxel_size_m = 0.1};
  const nextview::MapWindow window{{-2, -2, -2}, {65, 55, 33}};  // voxels
  const nextview::RayTable rays = nextview::make_ray_table(nextview::TiltedLineScan::paper());
  const nextview::PredictionRaster raster{.rays = rays, .range_max_m = 30.0};
  nextview::SurfaceParameters parameters;
  parameters.feasibility.lift_min_m = 0.5;  // where the lift can go, m above the world's z = 0
  parameters.feasibility.lift_max_m = 2.0;
  nextview::ViewPlanner planner(
      grid, window,
      std::make_unique<nextview::SurfaceStrategy>(
          raster, grid.voxel_size_m, nextview::icosahedron_orientations(2), parameters),
      {.max_views = 100});

  nextview::SensorPose pose{{1.0, 1.0, 1.2}, -std::numbers::pi / 4.0, 0.0};
  for (;;) {
    planner.fold(scan(pose, rays));
    const nextview::NextView& next = planner.next_view();
    if (const auto* ending = std::get_if<nextview::Ending>(&next)) {
      std::printf("%s after %d views: %s\n", nextview::to_string(ending->reason).data(),
                  planner.views(), ending->detail.c_str());
      break;
    }
    const auto& decision = std::get<nextview::Decision>(next);
    std::printf("view %d: %s\n", planner.views() + 1, decision.reason.c_str());
    pose = decision.pose;  // a robot would drive along decision.waypoints_m
  }
  const nextview::MapStatistics map = planner.builder().statistics();
  std::printf("%.1f m2 of surface in %d views\n", map.occupied_area_m2, planner.views());
}
