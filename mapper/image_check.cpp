#include "mapper/image_check.h"

#include <cmath>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include "sensor/vector_clones.h"

namespace nextview {

namespace {

// How far sines, cosines and matrix elements may be from an exact rotation.
constexpr double kTolerance = 1e-6;
// Positions within this many voxels of the origin have an index (VoxelGrid::voxel_of).
constexpr double kLargestIndex = 1e9;

void refuse(const std::string& reason) {
  throw std::invalid_argument("a range image that cannot be right: " + reason);
}

// Comparisons are written so that NaN fails them.
void check_angles(const std::vector<double>& sines, const std::vector<double>& cosines,
                  const std::string& axis) {
  if (sines.size() != cosines.size() || sines.size() < 2) {
    refuse("its ray table has " + std::to_string(sines.size()) + " sines and " +
           std::to_string(cosines.size()) + " cosines of " + axis);
  }
  for (std::size_t i = 0; i < sines.size(); ++i) {
    if (!(std::abs(sines[i] * sines[i] + cosines[i] * cosines[i] - 1.0) <= kTolerance)) {
      refuse("sine and cosine of " + axis + " " + std::to_string(i) + " belong to no angle");
    }
  }
}

void check_rotation(const Eigen::Matrix3d& rotation) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double product = rotation.col(i).dot(rotation.col(j));
      if (!(std::abs(product - (i == j ? 1.0 : 0.0)) <= kTolerance)) {
        refuse("world_from_sensor is not a rotation");
      }
    }
  }
}

NEXTVIEW_VECTOR_CLONES
bool any_negative(std::span<const float> ranges_m) {
  std::int32_t negative = 0;
#pragma omp simd reduction(| : negative)
  for (std::size_t n = 0; n < ranges_m.size(); ++n) {
    negative |= static_cast<std::int32_t>(ranges_m[n] < 0.0f);
  }
  return negative != 0;
}

}  // namespace

void check_range_image(const RangeImage& image, const VoxelGrid& grid, const MapWindow& window) {
  check_angles(image.rays.column_sin, image.rays.column_cos, "column");
  check_angles(image.rays.row_sin, image.rays.row_cos, "row");
  if (image.range_m.size() != image.rays.pixels()) {
    refuse(std::to_string(image.range_m.size()) + " ranges for " +
           std::to_string(image.rays.pixels()) + " pixels");
  }
  check_rotation(image.world_from_sensor);
  const RangeLimits& limits = image.limits;
  if (!(limits.min_m >= 0.0 && limits.min_m < limits.max_m && std::isfinite(limits.max_m))) {
    refuse("its range limits");
  }
  if (any_negative(image.range_m)) refuse("a negative range");

  for (int axis = 0; axis < 3; ++axis) {
    const double x = (image.position_m[axis] - grid.origin_m[axis]) / grid.voxel_size_m;
    if (!(std::abs(x) < kLargestIndex)) refuse("the sensor's position");
  }
  if (!window.contains(grid.voxel_of(image.position_m))) {
    throw std::invalid_argument("the sensor lies outside the map's window");
  }
}

}  // namespace nextview
