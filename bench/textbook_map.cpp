#include "bench/textbook_map.h"

#include <cmath>
#include <limits>

namespace nextview {

void TextbookMap::insert(const Eigen::Vector3d& sensor_m,
                         std::span<const Eigen::Vector3d> points_m) {
  const double per_m = 1.0 / grid_.voxel_size_m;
  const Eigen::Vector3d origin = (sensor_m - grid_.origin_m) * per_m;
  const auto raise = [this](std::size_t offset, Label to) {
    if (dense_.labels[offset] < to) dense_.labels[offset] = to;
  };
  for (const Eigen::Vector3d& point_m : points_m) {
    const Eigen::Vector3d ray = (point_m - sensor_m) * per_m;
    const double range = ray.norm();
    walk_textbook(dense_, origin, ray / range, std::numeric_limits<double>::infinity(),
                  [&](std::size_t offset, double t) {
                    raise(offset, t < range ? Label::Empty : Label::Occluded);
                    return true;
                  });
    raise(static_cast<std::size_t>(dense_.offset(grid_.voxel_of(point_m))), Label::Occupied);
  }
  raise(static_cast<std::size_t>(dense_.offset(grid_.voxel_of(sensor_m))), Label::Empty);
}

std::vector<Eigen::Vector3d> sensed_points_m(const RangeImage& image) {
  std::vector<Eigen::Vector3d> points_m;
  for (int v = 0; v < image.rays.rows(); ++v) {
    for (int u = 0; u < image.rays.columns(); ++u) {
      const float range_m =
          image.range_m[static_cast<std::size_t>(v) * image.rays.column_sin.size() +
                        static_cast<std::size_t>(u)];
      if (!std::isfinite(range_m)) continue;
      points_m.push_back(image.position_m +
                         double{range_m} * (image.world_from_sensor * image.rays.ray(u, v)));
    }
  }
  return points_m;
}

}  // namespace nextview
