#include "mapper/ray_ends.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mapper/window_limit.h"
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

inline double direction_along(const RowOfRays& rays, const AxisOfPoints& axis, int u) {
  const double n_x = -rays.column_sin[u];
  const double n_y = rays.column_cos[u] * rays.row_cos;
  const double n_z = rays.column_cos[u] * rays.row_sin;
  return axis.rotation[0] * n_x + axis.rotation[1] * n_y + axis.rotation[2] * n_z;
}

// A point's coordinate along an axis (eq. 1), relative to the grid's origin and moved away from it
// by half a voxel: divided by a voxel's size and truncated it is the index (eq. 2).
inline double moved_coordinate_m(const AxisOfPoints& axis, double half_m, double direction,
                                 double length_m) {
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
      return static_cast<std::int32_t>(
          moved_coordinate_m(axis, half_m, direction_along(row, axis, u), length_m) / voxel_size_m);
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
      const double product =
          moved_coordinate_m(axis, half_m, direction_along(row, axis, u), length_m) * per_m;
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

// What limit_of_ray needs to know of one axis of the window.
struct AxisOfWindow {
  double low_m, high_m;
  std::int32_t first, last;  // voxels
  std::int32_t stride;       // from one voxel to the next in the numbers of the window's voxels
};

// limit_of_ray for every ray of a row; by the letter, or with a product for the quotient as in
// end_voxels_by_reciprocal.
template <bool kByLetter>
[[gnu::always_inline]] inline bool limits_of_row(int columns, const RowOfRays& rays,
                                                 const AxisOfPoints (&axes)[3],
                                                 const AxisOfWindow (&window)[3],
                                                 double voxel_size_m,
                                                 std::int32_t* __restrict limits) {
  constexpr double kAbove = 1.0 + 0x1p-50;
  constexpr double kBelow = 1.0 - 0x1p-50;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const RowOfRays row = rays;
  const AxisOfPoints axis_x = axes[0], axis_y = axes[1], axis_z = axes[2];
  const AxisOfWindow window_x = window[0], window_y = window[1], window_z = window[2];
  const double half_m = 0.5 * voxel_size_m;
  const double per_m = 1.0 / voxel_size_m;
  std::int32_t doubt = 0;
#pragma omp simd reduction(| : doubt)
  for (int u = 0; u < columns; ++u) {
    const double x = direction_along(row, axis_x, u);
    const double y = direction_along(row, axis_y, u);
    const double z = direction_along(row, axis_z, u);
    const auto way_m = [](double direction, const AxisOfPoints& axis, const AxisOfWindow& of) {
      return std::abs((direction < 0.0 ? of.low_m : of.high_m) - axis.position_m);
    };
    const double way_x = way_m(x, axis_x, window_x);
    const double way_y = way_m(y, axis_y, window_y);
    const double way_z = way_m(z, axis_z, window_z);
    const double speed_x = std::abs(x), speed_y = std::abs(y), speed_z = std::abs(z);
    const bool by_x = way_x < kInfinity * speed_x;
    double way = by_x ? way_x : kInfinity;
    double speed = by_x ? speed_x : 1.0;
    const bool by_y = way_y * speed < way * speed_y;
    way = by_y ? way_y : way;
    speed = by_y ? speed_y : speed;
    const bool by_z = way_z * speed < way * speed_z;
    way = by_z ? way_z : way;
    speed = by_z ? speed_z : speed;
    const double length_m = way / speed;
    // A product in doubt does not matter along the axis the window is left by.
    const auto offset = [&](double direction, const AxisOfPoints& axis, const AxisOfWindow& of,
                            bool is_left) {
      const double moved_m = moved_coordinate_m(axis, half_m, direction, length_m);
      std::int32_t index;
      if constexpr (kByLetter) {
        index = static_cast<std::int32_t>(moved_m / voxel_size_m);
      } else {
        const double product = moved_m * per_m;
        index = static_cast<std::int32_t>(product * kBelow);
        const std::int32_t differs = index ^ static_cast<std::int32_t>(product * kAbove);
        doubt |= is_left ? 0 : differs;
      }
      index = index < of.first ? of.first : index;
      index = index > of.last ? of.last : index;
      const std::int32_t outermost = direction < 0.0 ? of.first : of.last;
      return ((is_left ? outermost : index) - of.first) * of.stride;
    };
    limits[u] = offset(x, axis_x, window_x, by_x & !by_y & !by_z) +
                offset(y, axis_y, window_y, by_y & !by_z) + offset(z, axis_z, window_z, by_z);
  }
  return doubt == 0;
}

NEXTVIEW_VECTOR_CLONES
bool limits_by_reciprocal(int columns, const RowOfRays& rays, const AxisOfPoints (&axes)[3],
                          const AxisOfWindow (&window)[3], double voxel_size_m,
                          std::int32_t* limits) {
  return limits_of_row<false>(columns, rays, axes, window, voxel_size_m, limits);
}

NEXTVIEW_VECTOR_CLONES
void limits_by_letter(int columns, const RowOfRays& rays, const AxisOfPoints (&axes)[3],
                      const AxisOfWindow (&window)[3], double voxel_size_m, std::int32_t* limits) {
  limits_of_row<true>(columns, rays, axes, window, voxel_size_m, limits);
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
  shadows_.clear();
  // Seldom outgrown.
  numbers_.clear(image.range_m.size() / 16);
  shadow_numbers_.clear(image.range_m.size() / 8);

  normals_.prepare(image);
  const int columns = image.rays.columns();
  for (auto* numbers : {&end_above_, &end_here_}) {
    numbers->assign(static_cast<std::size_t>(columns + NormalRow::kPadding), kNoEnd);
  }
  for (Row* row : {&row_, &row_above_}) row->resize(static_cast<std::size_t>(columns));
  std::ranges::fill(row_above_.limit, -1);  // above the image no ray leaves the window
  for (int v = 0; v < image.rays.rows(); ++v) {
    find_ends(image, grid, window, v);
    normals_.row(v, normal_row_);
    const RowEnds ends = row_.ends();
    for (const PixelRun& run : runs_.find(columns, ends, normal_row_)) add_run(run, window);
    for (const std::int32_t column : runs_.find_other_lines(columns, ends, row_above_.ends())) {
      add_shadow(column, window);
    }
    end_above_.swap(end_here_);
    std::swap(row_, row_above_);
  }
}

void RayEnds::Row::resize(std::size_t columns) {
  for (auto* part : {&end[0], &end[1], &end[2], &kind, &limit}) {
    part->resize(1 + columns + NormalRow::kPadding);
  }
}

RowEnds RayEnds::Row::ends() const {
  const auto column = [](const std::vector<std::int32_t>& part) { return part.data() + 1; };
  return {{column(end[0]), column(end[1]), column(end[2])}, column(kind), column(limit)};
}

void RayEnds::find_ends(const RangeImage& image, const VoxelGrid& grid, const MapWindow& window,
                        int v) {
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
  const EndsOfRow ends = {row_.end[0].data() + 1, row_.end[1].data() + 1, row_.end[2].data() + 1,
                          row_.kind.data() + 1};
  const bool by_reciprocal = has_reciprocal(grid.voxel_size_m);
  if (!by_reciprocal || !end_voxels_by_reciprocal(columns, rays, axes, grid.voxel_size_m, ends)) {
    end_voxels(columns, rays, axes, grid.voxel_size_m, ends);
  }

  std::int32_t stride = 1;
  const auto of_window = [&](int a) {
    const WindowExtent extent = window_extent(grid, window, a);
    const std::int32_t first = window.min[a];
    const std::int32_t step = stride;
    stride *= window.size[a];
    return AxisOfWindow{extent.low_m, extent.high_m, first, first + window.size[a] - 1, step};
  };
  const AxisOfWindow of_axes[] = {of_window(0), of_window(1), of_window(2)};
  std::int32_t* const limits = row_.limit.data() + 1;
  if (!by_reciprocal ||
      !limits_by_reciprocal(columns, rays, axes, of_axes, grid.voxel_size_m, limits)) {
    limits_by_letter(columns, rays, axes, of_axes, grid.voxel_size_m, limits);
  }
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

void RayEnds::add_shadow(std::int32_t column, const MapWindow& window) {
  const auto u = static_cast<std::size_t>(column);
  if (static_cast<RangeKind>(row_.kind[u + 1]) != RangeKind::Point) return;
  const std::uint32_t end = end_here_[u];
  if (!ends_[end].is_surface) return;
  const std::int32_t limit = row_.limit[u + 1];
  const std::uint64_t key = std::uint64_t{end} << 32 | static_cast<std::uint32_t>(limit);
  if (shadow_numbers_.number_of(key) < shadows_.size()) return;
  const int rest = limit / window.size[0];
  const VoxelIndex offset(limit % window.size[0], rest % window.size[1], rest / window.size[1]);
  shadows_.push_back({end, window.min + offset});
}

std::size_t RayEnds::memory_bytes() const {
  const std::size_t numbers =
      2 * 5 * row_.kind.capacity() + end_above_.capacity() + end_here_.capacity();
  return normals_.memory_bytes() + runs_.memory_bytes() + numbers_.memory_bytes() +
         numbers * sizeof(std::uint32_t) + ends_.capacity() * sizeof(RayEnd) +
         shadow_numbers_.memory_bytes() + shadows_.capacity() * sizeof(Shadow);
}

}  // namespace nextview
