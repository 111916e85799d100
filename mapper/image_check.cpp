#include "mapper/image_check.h"

#include <stdexcept>
#include <string>
#include <vector>

#include "lcmtypes/parameter_bounds.h"
#include "sensor/range_image_check.h"

namespace nextview {

namespace {

void refuse(const std::string& reason) {
  throw std::invalid_argument("a range image that cannot be right: " + reason);
}

void check_angles(const std::vector<double>& sines, const std::vector<double>& cosines,
                  const std::string& axis) {
  if (sines.size() != cosines.size() || sines.size() < 2) {
    refuse("its ray table has " + std::to_string(sines.size()) + " sines and " +
           std::to_string(cosines.size()) + " cosines of " + axis);
  }
  if (!on_unit_circle(sines, cosines)) {
    refuse("a sine and a cosine of " + axis + " belong to no angle");
  }
}

}  // namespace

void check_range_image(const RangeImage& image, const VoxelGrid& grid, const MapWindow& window) {
  check_angles(image.rays.column_sin, image.rays.column_cos, "column");
  check_angles(image.rays.row_sin, image.rays.row_cos, "row");
  if (image.range_m.size() != image.rays.pixels()) {
    refuse(std::to_string(image.range_m.size()) + " ranges for " +
           std::to_string(image.rays.pixels()) + " pixels");
  }
  if (!is_rotation(image.world_from_sensor)) refuse("world_from_sensor is not a rotation");
  if (!are_range_limits(image.limits)) refuse("its range limits");
  if (!are_ranges(image.range_m)) refuse("a negative range");

  for (int axis = 0; axis < 3; ++axis) {
    // What lies farther away has no index (VoxelGrid::voxel_of).
    const double x = (image.position_m[axis] - grid.origin_m[axis]) / grid.voxel_size_m;
    if (!bounds::kWindowMin.contain(x)) refuse("the sensor's position");
  }
  if (!window.contains(grid.voxel_of(image.position_m))) {
    throw std::invalid_argument("the sensor lies outside the map's window");
  }
}

}  // namespace nextview
