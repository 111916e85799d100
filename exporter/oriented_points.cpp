#include "exporter/oriented_points.h"

#include "exporter/point_clouds.h"

namespace nextview {

std::size_t OrientedPoints::IndexHash::operator()(const VoxelIndex& index) const {
  std::uint64_t hash = 0;
  for (int axis = 0; axis < 3; ++axis) {
    hash = (hash ^ static_cast<std::uint32_t>(index[axis])) * 0x9e3779b97f4a7c15U;
    hash ^= hash >> 32;
  }
  return hash;
}

void OrientedPoints::add(const RangeImage& image) {
  for_each_point(image, [this](const SensedPoint& point) {
    if (point.normal.isZero()) return;
    int axis = 0;
    point.normal.cwiseAbs().maxCoeff(&axis);
    const int side = 2 * axis + (point.normal[axis] < 0.0 ? 1 : 0);
    Plane& plane = planes_[grid_.voxel_of(point.position_m)][static_cast<std::size_t>(side)];
    plane.position_sum_m += point.position_m;
    plane.normal_sum += point.normal;
    plane.points += 1.0;
  });
}

const OrientedPoints::Planes* OrientedPoints::at(const VoxelIndex& voxel) const {
  const auto found = planes_.find(voxel);
  return found == planes_.end() ? nullptr : &found->second;
}

}  // namespace nextview
