#include "mapper/row_ends.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mapper/window_limit.h"
#include "sensor/vector_clones.h"

namespace nextview {

namespace {

// What eq. 1 and 2 need to know of one axis of the world.
struct AxisOfPoints {
  RayRow::Along rays;  // of the row
  double position_m;
  double origin_m;
};

// The pixels of a row, and how far their rays are followed.
struct RowOfRays {
  const double* __restrict column_sin;
  const double* __restrict column_cos;
  const float* __restrict range_m;
  RangeBounds bounds;
  double farthest_m;  // where a return is farther away
  double clear_m;     // where there is no return
};

// Where the rays of a row end; see RowEnds.
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
  return axis.rays.ray(rays.column_sin[u], rays.column_cos[u]);
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

}  // namespace

void EndRow::assign_none(int columns) {
  const auto size = static_cast<std::size_t>(columns) + 1 + kPadding;
  for (auto* part : {&end_[0], &end_[1], &end_[2], &kind_}) part->assign(size, 0);
  limit_.assign(size, -1);
}

RowEnds EndRow::ends() const {
  const auto column = [](const std::vector<std::int32_t>& part) { return part.data() + 1; };
  return {{column(end_[0]), column(end_[1]), column(end_[2])}, column(kind_), column(limit_)};
}

std::size_t EndRow::memory_bytes() const {
  return (3 * end_[0].capacity() + kind_.capacity() + limit_.capacity()) * sizeof(std::int32_t);
}

RowEndFinder::RowEndFinder(const RangeImage& image, const VoxelGrid& grid, const MapWindow& window)
    : image_(image),
      grid_(grid),
      window_(window),
      world_from_lines_(image.rays.world_from_lines(image.world_from_sensor)) {}

void RowEndFinder::find(int v, EndRow& row) const {
  const RayTable& table = image_.rays;
  const int columns = table.columns();
  const double farthest_m = kFarthestVoxels * grid_.voxel_size_m;
  const RowOfRays rays = {table.column_sin.data(),
                          table.column_cos.data(),
                          image_.range_m.data() + static_cast<std::ptrdiff_t>(v) * columns,
                          RangeBounds(image_.limits),
                          farthest_m,
                          std::min(image_.limits.max_m, farthest_m)};
  const RayRow directions = table.row(v, world_from_lines_);
  const auto axis = [&](int a) {
    return AxisOfPoints{directions.along(a), image_.position_m[a], grid_.origin_m[a]};
  };
  const AxisOfPoints axes[] = {axis(0), axis(1), axis(2)};
  const EndsOfRow ends = {row.end_[0].data() + 1, row.end_[1].data() + 1, row.end_[2].data() + 1,
                          row.kind_.data() + 1};
  const bool by_reciprocal = has_reciprocal(grid_.voxel_size_m);
  if (!by_reciprocal || !end_voxels_by_reciprocal(columns, rays, axes, grid_.voxel_size_m, ends)) {
    end_voxels(columns, rays, axes, grid_.voxel_size_m, ends);
  }

  std::int32_t stride = 1;
  const auto of_window = [&](int a) {
    const WindowExtent extent = window_extent(grid_, window_, a);
    const std::int32_t first = window_.min[a];
    const std::int32_t step = stride;
    stride *= window_.size[a];
    return AxisOfWindow{extent.low_m, extent.high_m, first, first + window_.size[a] - 1, step};
  };
  const AxisOfWindow of_axes[] = {of_window(0), of_window(1), of_window(2)};
  std::int32_t* const limits = row.limit_.data() + 1;
  if (!by_reciprocal ||
      !limits_by_reciprocal(columns, rays, axes, of_axes, grid_.voxel_size_m, limits)) {
    limits_by_letter(columns, rays, axes, of_axes, grid_.voxel_size_m, limits);
  }
}

VoxelIndex RowEndFinder::voxel_of_limit(std::int32_t limit) const {
  const int rest = limit / window_.size[0];
  return window_.min +
         VoxelIndex(limit % window_.size[0], rest % window_.size[1], rest / window_.size[1]);
}

}  // namespace nextview
