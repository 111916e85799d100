#include "mapper/ray_ends.h"

#include <algorithm>
#include <cmath>

#include "sensor/vector_clones.h"

namespace nextview {

namespace {

// What eq. 1 and 2 need to know of one axis of the world.
struct AxisOfPoints {
  double rotation[3];  // the axis' row of world_from_sensor
  double position_m;
  double origin_m;
};

// The rays of a row, and how far they are followed.
struct RowOfRays {
  const double* __restrict column_sin;
  const double* __restrict column_cos;
  double row_sin, row_cos;
  const float* __restrict range_m;
  RangeBounds bounds;
  double farthest_m;  // where a return is farther away
  double clear_m;     // where there is no return
};

// Where the rays of a row end; see RayEnds::Row.
struct EndsOfRow {
  std::int32_t* __restrict x;
  std::int32_t* __restrict y;
  std::int32_t* __restrict z;
  std::int32_t* __restrict kind;
};

inline std::int32_t kind_of(const RowOfRays& rays, float range_m) {
  return static_cast<std::int32_t>(rays.bounds.kind_of(range_m));
}

inline double followed_m(const RowOfRays& rays, float range_m) {
  const double d = static_cast<double>(range_m);
  const double point_m = d < rays.farthest_m ? d : rays.farthest_m;
  const double length_m = range_m > rays.bounds.farthest_m ? rays.clear_m : point_m;
  return range_m >= rays.bounds.nearest_m ? length_m : 0.0;
}

// A point's coordinate along an axis (eq. 1), relative to the grid's origin and moved away from it
// by half a voxel: divided by a voxel's size and truncated it is the index (eq. 2).
inline double moved_coordinate_m(const RowOfRays& rays, const AxisOfPoints& axis, double half_m,
                                 int u, double length_m) {
  const double n_x = -rays.column_sin[u];
  const double n_y = rays.column_cos[u] * rays.row_cos;
  const double n_z = rays.column_cos[u] * rays.row_sin;
  const double direction = axis.rotation[0] * n_x + axis.rotation[1] * n_y + axis.rotation[2] * n_z;
  const double x = axis.position_m + length_m * direction - axis.origin_m;
  return x + std::copysign(half_m, x);
}

// Eq. 2 by the letter.
NEXTVIEW_VECTOR_CLONES
void end_voxels(int columns, const RowOfRays& rays, const AxisOfPoints (&axes)[3],
                double voxel_size_m, EndsOfRow ends) {
  const RowOfRays row = rays;
  const AxisOfPoints axis_x = axes[0], axis_y = axes[1], axis_z = axes[2];
  const double half_m = 0.5 * voxel_size_m;
#pragma omp simd
  for (int u = 0; u < columns; ++u) {
    const double length_m = followed_m(row, row.range_m[u]);
    const auto index = [&](const AxisOfPoints& axis) {
      return static_cast<std::int32_t>(moved_coordinate_m(row, axis, half_m, u, length_m) /
                                       voxel_size_m);
    };
    ends.x[u] = index(axis_x);
    ends.y[u] = index(axis_y);
    ends.z[u] = index(axis_z);
    ends.kind[u] = kind_of(row, row.range_m[u]);
  }
}

// The same with a product for the quotient, which takes a fraction of the time. The product may be
// wrong in its last bits: false where that could matter, and then the row has to be done by the
// letter. With u = 2^-53, the quotient as rounded is within 3 u of the product as rounded (one each
// for the reciprocal and both roundings), and the bounds are 7 u away or more.
NEXTVIEW_VECTOR_CLONES
bool end_voxels_by_reciprocal(int columns, const RowOfRays& rays, const AxisOfPoints (&axes)[3],
                              double voxel_size_m, EndsOfRow ends) {
  constexpr double kAbove = 1.0 + 0x1p-50;
  constexpr double kBelow = 1.0 - 0x1p-50;
  const RowOfRays row = rays;
  const AxisOfPoints axis_x = axes[0], axis_y = axes[1], axis_z = axes[2];
  const double half_m = 0.5 * voxel_size_m;
  const double per_m = 1.0 / voxel_size_m;
  std::int32_t doubt = 0;
#pragma omp simd reduction(| : doubt)
  for (int u = 0; u < columns; ++u) {
    const double length_m = followed_m(row, row.range_m[u]);
    const auto index = [&](const AxisOfPoints& axis, std::int32_t& bound) {
      const double product = moved_coordinate_m(row, axis, half_m, u, length_m) * per_m;
      bound = static_cast<std::int32_t>(product * kAbove);
      return static_cast<std::int32_t>(product * kBelow);
    };
    std::int32_t x, y, z;
    ends.x[u] = index(axis_x, x);
    ends.y[u] = index(axis_y, y);
    ends.z[u] = index(axis_z, z);
    ends.kind[u] = kind_of(row, row.range_m[u]);
    doubt |= (ends.x[u] ^ x) | (ends.y[u] ^ y) | (ends.z[u] ^ z);
  }
  return doubt == 0;
}

// Beyond these a reciprocal loses bits.
bool has_reciprocal(double voxel_size_m) { return voxel_size_m > 1e-300 && voxel_size_m < 1e300; }

constexpr std::uint32_t kNoEnd = ~std::uint32_t{0};

// An end as a number: its voxel, relative to the sensor's in 16 bits an axis, and whether it is a
// surface. Ends lie within kFarthestVoxels of the sensor, so 16 bits hold them.
std::uint64_t key_of(const VoxelIndex& displacement, bool is_surface) {
  std::uint64_t key = is_surface ? 1 : 0;
  for (int axis = 0; axis < 3; ++axis) {
    key = key << 16 | static_cast<std::uint16_t>(displacement[axis]);
  }
  return key;
}

void add_points(const PixelRun& run, SurfaceVoxel& seen) {
  for (std::size_t axis = 0; axis < 3; ++axis) seen.normal_sum[axis] += run.normal_sum[axis];
  seen.normal_count += static_cast<std::uint32_t>(run.normal_sum[3]);
  seen.quality = std::max(seen.quality, static_cast<std::uint16_t>(run.quality));
}

}  // namespace

void RayEnds::collect(const RangeImage& image, const VoxelGrid& grid, const MapWindow& window) {
  sensor_ = grid.voxel_of(image.position_m);
  counts_ = {};
  ends_.clear();
  numbers_.clear(image.range_m.size() / 16);  // seldom outgrown

  normals_.prepare(image);
  const int columns = image.rays.columns();
  for (auto* numbers : {&end_above_, &end_here_}) {
    numbers->assign(static_cast<std::size_t>(columns + NormalRow::kPadding), kNoEnd);
  }
  for (int v = 0; v < image.rays.rows(); ++v) {
    find_ends(image, grid, v);
    normals_.row(v, normal_row_);
    const auto column = [](const std::vector<std::int32_t>& row) { return row.data() + 1; };
    const RowEnds ends = {{column(row_.end[0]), column(row_.end[1]), column(row_.end[2])},
                          column(row_.kind)};
    for (const PixelRun& run : runs_.find(columns, ends, normal_row_)) add_run(run, window);
    end_above_.swap(end_here_);
  }
}

void RayEnds::find_ends(const RangeImage& image, const VoxelGrid& grid, int v) {
  const int columns = image.rays.columns();
  const auto size = static_cast<std::size_t>(columns);
  const auto row = static_cast<std::size_t>(v);
  const double farthest_m = kFarthestVoxels * grid.voxel_size_m;
  const RowOfRays rays = {image.rays.column_sin.data(),
                          image.rays.column_cos.data(),
                          image.rays.row_sin[row],
                          image.rays.row_cos[row],
                          image.range_m.data() + row * size,
                          RangeBounds(image.limits),
                          farthest_m,
                          std::min(image.limits.max_m, farthest_m)};
  const auto axis = [&](int a) {
    const Eigen::Matrix3d& r = image.world_from_sensor;
    return AxisOfPoints{{r(a, 0), r(a, 1), r(a, 2)}, image.position_m[a], grid.origin_m[a]};
  };
  const AxisOfPoints axes[] = {axis(0), axis(1), axis(2)};
  for (auto* part : {&row_.end[0], &row_.end[1], &row_.end[2], &row_.kind}) {
    part->resize(1 + size + NormalRow::kPadding);
  }
  const EndsOfRow ends = {row_.end[0].data() + 1, row_.end[1].data() + 1, row_.end[2].data() + 1,
                          row_.kind.data() + 1};
  if (has_reciprocal(grid.voxel_size_m) &&
      end_voxels_by_reciprocal(columns, rays, axes, grid.voxel_size_m, ends)) {
    return;
  }
  end_voxels(columns, rays, axes, grid.voxel_size_m, ends);
}

void RayEnds::add_run(const PixelRun& run, const MapWindow& window) {
  const auto u = static_cast<std::size_t>(run.begin) + 1;
  const std::int64_t pixels = run.end - run.begin;
  const VoxelIndex voxel(row_.end[0][u], row_.end[1][u], row_.end[2][u]);
  switch (static_cast<RangeKind>(row_.kind[u])) {
    case RangeKind::Point:
      if (window.contains(voxel)) {
        counts_.points += pixels;
        add_points(run, end_of(run, voxel, true).seen);
      } else {
        counts_.points_outside += pixels;
        end_of(run, voxel, false);
      }
      return;
    case RangeKind::NoReturn:
      counts_.no_returns += pixels;
      end_of(run, voxel, false);
      return;
    case RangeKind::Invalid:
      counts_.invalid += pixels;
      return;
  }
}

RayEnd& RayEnds::end_of(const PixelRun& run, const VoxelIndex& voxel, bool is_surface) {
  // Most runs end where the run above does.
  std::uint32_t number = end_above_[static_cast<std::size_t>(run.begin)];
  if (number >= ends_.size() || ends_[number].voxel != voxel ||
      ends_[number].is_surface != is_surface) {
    number = number_of(voxel, is_surface);
  }
  // In pieces of one size, which are quicker to write than what is asked for; what goes beyond the
  // run is overwritten by the next, or never read as the end of a run that has none: its voxel is
  // looked at.
  constexpr int kPiece = 8;
  static_assert(kPiece <= NormalRow::kPadding);
  for (int u = run.begin; u < run.end; u += kPiece) {
    std::fill_n(&end_here_[static_cast<std::size_t>(u)], kPiece, number);
  }
  return ends_[number];
}

std::uint32_t RayEnds::number_of(const VoxelIndex& voxel, bool is_surface) {
  const std::uint32_t number = numbers_.number_of(key_of(voxel - sensor_, is_surface));
  if (number == ends_.size()) ends_.push_back({voxel, is_surface, {}});
  return number;
}

std::size_t RayEnds::memory_bytes() const {
  const std::size_t numbers =
      4 * row_.kind.capacity() + end_above_.capacity() + end_here_.capacity();
  return normals_.memory_bytes() + runs_.memory_bytes() + numbers_.memory_bytes() +
         numbers * sizeof(std::uint32_t) + ends_.capacity() * sizeof(RayEnd);
}

}  // namespace nextview
