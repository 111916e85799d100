#include "mapper/mapper_config.h"

#include <string>

#include "lcmtypes/bus.h"

namespace nextview {

VoxelGrid grid_of(const run_config_t& config) {
  return {.voxel_size_m = config.map.voxel_size_m,
          .origin_m = Eigen::Vector3d(config.map.map_origin_m)};
}

MapWindow window_of(const run_config_t& config) {
  return {.min = VoxelIndex(config.map.window_min), .size = VoxelIndex(config.map.window_size)};
}

void check_fits_run(const range_image_t& image, const run_config_t& config) {
  check_fits_run(config, image.view, image.attempt);
  const VoxelGrid grid = grid_of(config);
  const Eigen::Vector3d position_m(image.position_m);
  // voxel_of is defined near the map only.
  const bool near = ((position_m - grid.origin_m) / grid.voxel_size_m).cwiseAbs().maxCoeff() < 1e9;
  if (!near || !window_of(config).contains(grid.voxel_of(position_m))) {
    throw RejectedMessage("the sensor lies outside the map");
  }
}

}  // namespace nextview
