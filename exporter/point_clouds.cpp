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

const std::string kOccupiedVoxels =
    "nextview: Occupied voxels; centre in metres, world frame, z up; mean normal; quality 0..1";

template <class See>
void for_each_occupied(const VoxelMap& map, See see) {
  for_each_voxel(map.window(), [&](const VoxelIndex& voxel) {
    if (map.label(voxel) == Label::Occupied) see(voxel);
  });
}

std::uint64_t count_occupied(const VoxelMap& map) {
  std::uint64_t occupied = 0;
  for_each_occupied(map, [&](const VoxelIndex&) { ++occupied; });
  return occupied;
}

// Centre, normal and quality.
void write_voxel(PointWriter& writer, const VoxelMap& map, const VoxelIndex& voxel) {
  const SurfaceVoxel* surface = map.surface(voxel);
  const SurfaceVoxel seen = surface == nullptr ? SurfaceVoxel() : *surface;
  writer << map.grid().center_m(voxel) << seen.mean_normal()
         << static_cast<float>(seen.quality_01());
}

}  // namespace

void write_occupied_voxels(std::ostream& out, PointFormat format, const VoxelMap& map) {
  PointWriter writer(out, format, fields_with({"quality", "quality"}), count_occupied(map),
                     kOccupiedVoxels);
  for_each_occupied(map, [&](const VoxelIndex& voxel) { write_voxel(writer, map, voxel); });
}

void write_filled_voxels(std::ostream& out, PointFormat format, const VoxelMap& map,
                         std::span<const VoxelIndex> filled) {
  std::vector<PointField> fields = fields_with({"quality", "quality"});
  fields.push_back({"filled", "filled", PointField::Type::Unsigned});
  PointWriter writer(out, format, fields, count_occupied(map) + filled.size(),
                     kOccupiedVoxels + "; filled 1: not sensed, a hole of one voxel");
  for_each_occupied(map, [&](const VoxelIndex& voxel) {
    write_voxel(writer, map, voxel);
    writer << std::uint32_t{0};
  });
  for (const VoxelIndex& voxel : filled) {
    write_voxel(writer, map, voxel);
    writer << std::uint32_t{1};
  }
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
