#include "exporter/point_clouds.h"

#include "mapper/normals.h"

namespace nextview {
namespace {

PointWriter& operator<<(PointWriter& out, const Eigen::Vector3d& vector) {
  return out << static_cast<float>(vector.x()) << static_cast<float>(vector.y())
             << static_cast<float>(vector.z());
}

std::vector<PointField> fields_with(const PointField& last) {
  std::vector<PointField> fields = position_fields();
  for (const PointField& field : normal_fields()) fields.push_back(field);
  fields.push_back(last);
  return fields;
}

std::uint64_t count_points(const RangeImage& image) {
  const RangeBounds bounds(image.limits);
  std::uint64_t points = 0;
  for (const float range_m : image.range_m) {
    points += bounds.kind_of(range_m) == RangeKind::Point ? 1 : 0;
  }
  return points;
}

}  // namespace

void write_occupied_voxels(std::ostream& out, PointFormat format, const VoxelMap& map) {
  std::uint64_t occupied = 0;
  for_each_voxel(map.window(), [&](const VoxelIndex& voxel) {
    occupied += map.label(voxel) == Label::Occupied ? 1 : 0;
  });
  PointWriter writer(out, format, fields_with({"quality", "quality"}), occupied,
                     "nextview: Occupied voxels; centre in metres, world frame, z up; mean normal; "
                     "quality 0..1");
  for_each_voxel(map.window(), [&](const VoxelIndex& voxel) {
    if (map.label(voxel) != Label::Occupied) return;
    const SurfaceVoxel* surface = map.surface(voxel);
    const SurfaceVoxel seen = surface == nullptr ? SurfaceVoxel() : *surface;
    writer << map.grid().center_m(voxel) << seen.mean_normal()
           << static_cast<float>(seen.quality_01());
  });
}

void for_each_point(const RangeImage& image, const std::function<void(const SensedPoint&)>& see) {
  const RangeBounds bounds(image.limits);
  NormalEstimator estimator;
  NormalRow normals;
  estimator.prepare(image);
  const int columns = image.rays.columns();
  for (int v = 0; v < image.rays.rows(); ++v) {
    estimator.row(v, normals);
    for (int u = 0; u < columns; ++u) {
      const auto column = static_cast<std::size_t>(u);
      const float range_m = image.range_m[static_cast<std::size_t>(v * columns + u)];
      if (bounds.kind_of(range_m) != RangeKind::Point) continue;
      const Eigen::Vector3d direction = image.world_from_sensor * image.rays.ray(u, v);
      const Eigen::Vector3d normal =
          Eigen::Vector3d(normals.x[column], normals.y[column], normals.z[column]);
      see({image.position_m + static_cast<double>(range_m) * direction,
           normal.isZero() ? normal : Eigen::Vector3d(normal.normalized())});
    }
  }
}

void write_sensed_points(std::ostream& out, PointFormat format,
                         std::span<const RangeImage* const> images) {
  std::uint64_t points = 0;
  for (const RangeImage* image : images) points += count_points(*image);
  PointWriter writer(out, format, fields_with({"view", "view", PointField::Type::Unsigned}), points,
                     "nextview: sensed points in metres, world frame, z up; normal towards the "
                     "sensor; view from 1");
  std::uint32_t view = 0;
  for (const RangeImage* image : images) {
    ++view;
    for_each_point(*image, [&](const SensedPoint& point) {
      writer << point.position_m << point.normal << view;
    });
  }
}

}  // namespace nextview
