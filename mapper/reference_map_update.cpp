#include "mapper/reference_map_update.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mapper/image_check.h"
#include "mapper/integer_line.h"
#include "mapper/row_ends.h"
#include "mapper/window_limit.h"

namespace nextview {

namespace {

// The direction of a pixel's ray in the world frame (eq. 1).
Eigen::Vector3d direction_of(const RangeImage& image, int u, int v) {
  const auto column = static_cast<std::size_t>(u);
  return image.rays.row(v, image.rays.world_from_lines(image.world_from_sensor))
      .ray(image.rays.column_sin[column], image.rays.column_cos[column]);
}

}  // namespace

ReferenceMapUpdate::ReferenceMapUpdate(const VoxelGrid& grid, const MapWindow& window)
    : grid_(grid), window_(window) {
  const Eigen::Matrix<std::size_t, 3, 1> size = window.size.cast<std::size_t>();
  labels_.assign(size[0] * size[1] * size[2], Label::Unmarked);
}

std::size_t ReferenceMapUpdate::place(const VoxelIndex& voxel) const {
  const Eigen::Matrix<std::size_t, 3, 1> offset = (voxel - window_.min).cast<std::size_t>();
  const Eigen::Matrix<std::size_t, 3, 1> size = window_.size.cast<std::size_t>();
  return offset[0] + size[0] * (offset[1] + size[1] * offset[2]);
}

void ReferenceMapUpdate::fold(const RangeImage& image) {
  check_range_image(image, grid_, window_);
  const VoxelIndex sensor = grid_.voxel_of(image.position_m);
  const double farthest_m = kFarthestVoxels * grid_.voxel_size_m;
  const RangeBounds bounds(image.limits);
  for (int v = 0; v < image.rays.rows(); ++v) {
    for (int u = 0; u < image.rays.columns(); ++u) {
      const auto pixel = static_cast<std::size_t>(v * image.rays.columns() + u);
      const RangeKind kind = bounds.kind_of(image.range_m[pixel]);
      if (kind == RangeKind::Invalid) continue;
      const double followed_m =
          kind == RangeKind::NoReturn ? image.limits.max_m : image.range_m[pixel];
      const double distance_m = std::min(followed_m, farthest_m);
      const Eigen::Vector3d direction = direction_of(image, u, v);
      const VoxelIndex end = grid_.voxel_of(image.position_m + distance_m * direction);
      const bool is_surface = kind == RangeKind::Point && window_.contains(end);
      mark_free(sensor, end);
      if (!is_surface) continue;
      mark_hidden(end, limit_of_ray(grid_, window_, image.position_m, direction));
      labels_[place(end)] = Label::Occupied;
      const PointNormal normal = reference_normal(image, u, v);
      SurfaceVoxel& voxel = surfaces_[place(end)];
      if (normal.x == 0 && normal.y == 0 && normal.z == 0) continue;
      voxel.normal_sum[0] += normal.x;
      voxel.normal_sum[1] += normal.y;
      voxel.normal_sum[2] += normal.z;
      voxel.normal_count += 1;
      voxel.quality = std::max(voxel.quality, static_cast<std::uint16_t>(normal.quality));
    }
  }
  label_occlusion_planes();
}

void ReferenceMapUpdate::move_window(const VoxelIndex& new_min) {
  ReferenceMapUpdate moved(grid_, {new_min, window_.size});
  for_each_voxel(moved.window_, [&](const VoxelIndex& voxel) {
    moved.labels_[moved.place(voxel)] = label(voxel);
    const SurfaceVoxel* const kept = surface(voxel);
    if (kept != nullptr) moved.surfaces_[moved.place(voxel)] = *kept;
  });
  *this = std::move(moved);
  label_occlusion_planes();
}

void ReferenceMapUpdate::mark_free(const VoxelIndex& sensor, const VoxelIndex& end) {
  const IntegerLine line = line_between(sensor, end);
  for (int k = 0; k <= line.steps && window_.contains(line.at(k)); ++k) {
    Label& label = labels_[place(line.at(k))];
    if (label != Label::Occupied) label = Label::Empty;
  }
}

void ReferenceMapUpdate::mark_hidden(const VoxelIndex& point, const VoxelIndex& limit) {
  const IntegerLine line = line_between(point, limit);
  for (int k = 1; k <= line.steps; ++k) {
    Label& label = labels_[place(line.at(k))];
    if (label == Label::Unmarked) label = Label::Occluded;
  }
}

int ReferenceMapUpdate::empty_neighbours(const VoxelIndex& voxel) const {
  int count = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int step : {-1, 1}) {
      VoxelIndex neighbour = voxel;
      neighbour[axis] += step;
      if (label(neighbour) == Label::Empty) ++count;
    }
  }
  return count;
}

void ReferenceMapUpdate::label_occlusion_planes() {
  for (int k = 0; k < window_.size[2]; ++k) {
    for (int j = 0; j < window_.size[1]; ++j) {
      for (int i = 0; i < window_.size[0]; ++i) {
        const VoxelIndex voxel = window_.min + VoxelIndex(i, j, k);
        Label& label = labels_[place(voxel)];
        if (label != Label::Occluded && label != Label::OcclusionPlane) continue;
        label = empty_neighbours(voxel) > 0 ? Label::OcclusionPlane : Label::Occluded;
      }
    }
  }
}

Label ReferenceMapUpdate::label(const VoxelIndex& voxel) const {
  return window_.contains(voxel) ? labels_[place(voxel)] : Label::Unmarked;
}

const SurfaceVoxel* ReferenceMapUpdate::surface(const VoxelIndex& voxel) const {
  if (!window_.contains(voxel)) return nullptr;
  const auto found = surfaces_.find(place(voxel));
  return found == surfaces_.end() ? nullptr : &found->second;
}

MapStatistics ReferenceMapUpdate::statistics() const {
  MapStatistics statistics;
  std::int64_t quality_sum = 0;
  std::uint16_t quality_min = SurfaceVoxel::kQualityUnit;
  for (int k = 0; k < window_.size[2]; ++k) {
    for (int j = 0; j < window_.size[1]; ++j) {
      for (int i = 0; i < window_.size[0]; ++i) {
        const VoxelIndex voxel = window_.min + VoxelIndex(i, j, k);
        ++statistics.voxels[static_cast<std::size_t>(label(voxel))];
        if (label(voxel) == Label::OcclusionPlane) {
          statistics.occlusion_plane_faces += empty_neighbours(voxel);
        }
        if (label(voxel) == Label::Occupied) {
          statistics.occupied_faces += empty_neighbours(voxel);
          quality_sum += surface(voxel)->quality;
          quality_min = std::min(quality_min, surface(voxel)->quality);
        }
      }
    }
  }
  const double face_m2 = grid_.voxel_size_m * grid_.voxel_size_m;
  statistics.occupied_area_m2 = static_cast<double>(statistics.occupied_faces) * face_m2;
  statistics.occlusion_plane_area_m2 =
      static_cast<double>(statistics.occlusion_plane_faces) * face_m2;
  const std::int64_t occupied = statistics.voxels[static_cast<std::size_t>(Label::Occupied)];
  if (occupied > 0) {
    statistics.mean_quality = static_cast<double>(quality_sum) /
                              static_cast<double>(occupied * SurfaceVoxel::kQualityUnit);
    statistics.min_quality = static_cast<double>(quality_min) / SurfaceVoxel::kQualityUnit;
  }
  return statistics;
}

namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// One pixel's neighbourhood in an image, by the definitions of normals.h. Pixels outside the image
// have range NaN.
class PixelNeighbourhood {
 public:
  explicit PixelNeighbourhood(const RangeImage& image)
      : image_(image),
        column_stride_(normal_stride(image.rays.column_sin, image.rays.column_cos)),
        row_stride_(normal_stride(image.rays.row_sin, image.rays.row_cos)) {}

  float range(int u, int v) const {
    const RayTable& rays = image_.rays;
    if (u < 0 || u >= rays.columns() || v < 0 || v >= rays.rows()) return kNaN;
    return usable_range(image_.range_m[static_cast<std::size_t>(v * rays.columns() + u)],
                        UsableRanges(RangeBounds(image_.limits)));
  }
  float w(int u, int v) const { return 1.0f / range(u, v); }

  // The slope along the row towards the neighbour on one side, side = -1 or 1.
  float row_slope(int u, int v, int side) const {
    const AngleStep step = column_step(u, side);
    return slope_to(w(u, v), w(u + side * column_stride_, v), step.cosine, step.inverse_sine);
  }
  float row_bend(int u, int v) const {
    return relative_bend(row_slope(u, v, -1), row_slope(u, v, 1), range(u, v));
  }
  float chosen_row_slope(int u, int v) const {
    const auto step = [&](int side) {
      const AngleStep angle = column_step(u, side);
      return squared_step(range(u, v), range(u + side * column_stride_, v), angle.cosine,
                          angle.sine);
    };
    return choose_slope(row_slope(u, v, -1), row_slope(u, v, 1), row_bend(u, v),
                        row_bend(u - column_stride_, v), row_bend(u + column_stride_, v), step(-1),
                        step(1));
  }

  // The slope along the column, once the slope along the row is known.
  float column_slope(int u, int v, int side) const {
    if (u < 0 || u >= image_.rays.columns()) return kNaN;
    const AngleStep step = row_step(v, side);
    const float c =
        constant_along_column(w(u, v), chosen_row_slope(u, v), column_sin(u), column_cos(u));
    return slope_to(w(u, v) - c, w(u, v + side * row_stride_) - c, step.cosine, step.inverse_sine);
  }
  float column_bend(int u, int v) const {
    return relative_bend(column_slope(u, v, -1), column_slope(u, v, 1), range(u, v));
  }
  float chosen_column_slope(int u, int v) const {
    const auto step = [&](int side) {
      const AngleStep angle = row_step(v, side);
      return squared_step(range(u, v), range(u, v + side * row_stride_), angle.cosine, angle.sine);
    };
    return choose_slope(column_slope(u, v, -1), column_slope(u, v, 1), column_bend(u, v),
                        column_bend(u, v - row_stride_), column_bend(u, v + row_stride_), step(-1),
                        step(1));
  }

  float column_sin(int u) const {
    return static_cast<float>(image_.rays.column_sin[static_cast<std::size_t>(u)]);
  }
  float column_cos(int u) const {
    return static_cast<float>(image_.rays.column_cos[static_cast<std::size_t>(u)]);
  }

 private:
  AngleStep column_step(int u, int side) const {
    if (u < 0 || u >= image_.rays.columns()) return {kNaN, kNaN, kNaN};
    return angle_step(image_.rays.column_sin, image_.rays.column_cos, u, u + side * column_stride_);
  }
  AngleStep row_step(int v, int side) const {
    if (v < 0 || v >= image_.rays.rows()) return {kNaN, kNaN, kNaN};
    return angle_step(image_.rays.row_sin, image_.rays.row_cos, v, v + side * row_stride_);
  }

  const RangeImage& image_;
  int column_stride_;
  int row_stride_;
};

}  // namespace

PointNormal reference_normal(const RangeImage& image, int u, int v) {
  const PixelNeighbourhood pixels(image);
  const Eigen::Matrix3d world_from_lines = image.rays.world_from_lines(image.world_from_sensor);
  float rotation[3][3];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rotation[i][j] = static_cast<float>(world_from_lines(i, j));
  }
  const float sin_b = static_cast<float>(image.rays.row_sin[static_cast<std::size_t>(v)]);
  const float cos_b = static_cast<float>(image.rays.row_cos[static_cast<std::size_t>(v)]);
  return point_normal(pixels.w(u, v), pixels.chosen_row_slope(u, v),
                      pixels.chosen_column_slope(u, v),
                      {pixels.column_sin(u), pixels.column_cos(u), sin_b, cos_b}, rotation);
}

}  // namespace nextview
