#include "mapper/ray_ends.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "mapper/vector_clones.h"

namespace nextview {

namespace {

// Why a ray ends where it does.
enum PixelKind : std::int32_t { kPoint = 0, kNoReturn = 1, kInvalid = 2 };

// A row of pixels is worked on in runs that share an end; sums over this many points fit 32 bits.
constexpr int kLongestRun = 1 << 16;

NEXTVIEW_VECTOR_CLONES
void follow_ranges(int columns, const float* __restrict range_m, double farthest_m, double clear_m,
                   double* __restrict length_m, std::int32_t* __restrict kind) {
#pragma omp simd
  for (int u = 0; u < columns; ++u) {
    const float d = range_m[u];
    const bool is_finite = d <= std::numeric_limits<float>::max();
    kind[u] = static_cast<std::int32_t>(!is_finite) + static_cast<std::int32_t>(d != d);
    const double point_m =
        static_cast<double>(d) < farthest_m ? static_cast<double>(d) : farthest_m;
    const double followed_m = is_finite ? point_m : clear_m;
    length_m[u] = d == d ? followed_m : 0.0;
  }
}

// What eq. 1 and 2 need to know of one axis of the world.
struct AxisOfPoints {
  double rotation[3];  // the axis' row of world_from_sensor
  double position_m;
  double origin_m;
  double voxel_size_m;
};

NEXTVIEW_VECTOR_CLONES
void end_voxels(int columns, AxisOfPoints axis, const double* __restrict length_m,
                const double* __restrict column_sin, const double* __restrict column_cos,
                double row_sin, double row_cos, std::int32_t* __restrict end) {
  const double half_m = 0.5 * axis.voxel_size_m;
#pragma omp simd
  for (int u = 0; u < columns; ++u) {
    const double n_x = -column_sin[u];
    const double n_y = column_cos[u] * row_cos;
    const double n_z = column_cos[u] * row_sin;
    const double direction =
        axis.rotation[0] * n_x + axis.rotation[1] * n_y + axis.rotation[2] * n_z;
    const double point = axis.position_m + length_m[u] * direction;  // eq. 1
    const double x = point - axis.origin_m;
    end[u] =
        static_cast<std::int32_t>((x + std::copysign(half_m, x)) / axis.voxel_size_m);  // eq. 2
  }
}

NEXTVIEW_VECTOR_CLONES
void compare_neighbours(int columns, const std::int32_t* x, const std::int32_t* y,
                        const std::int32_t* z, const std::int32_t* kind,
                        std::int32_t* __restrict same_as_last) {
  same_as_last[0] = 0;
#pragma omp simd
  for (int u = 1; u < columns; ++u) {
    const std::int32_t difference =
        (x[u] ^ x[u - 1]) | (y[u] ^ y[u - 1]) | (z[u] ^ z[u - 1]) | (kind[u] ^ kind[u - 1]);
    same_as_last[u] = difference == 0;
  }
}

// An end as a key: its voxel relative to the sensor's, 16 bits an axis, and whether it is a
// surface. Ends lie within kFarthestVoxels of the sensor, so 16 bits hold them.
constexpr std::uint64_t kNoKey = ~std::uint64_t{0};

std::uint64_t key_of(const VoxelIndex& displacement, bool is_surface) {
  std::uint64_t key = is_surface ? 1 : 0;
  for (int axis = 0; axis < 3; ++axis) {
    key = key << 16 | static_cast<std::uint16_t>(displacement[axis]);
  }
  return key;
}

// Where a key belongs in a table of a power of two of places: the top bits of its product with the
// golden ratio.
std::size_t first_place(std::uint64_t key, std::size_t places) {
  return static_cast<std::size_t>(key * 0x9e3779b97f4a7c15u >> (64 - std::countr_zero(places)));
}

}  // namespace

void RayEnds::collect(const RangeImage& image, const VoxelGrid& grid, const MapWindow& window) {
  sensor_ = grid.voxel_of(image.position_m);
  counts_ = {};
  ends_.clear();
  for (const std::uint32_t place : used_) table_[place].key = kNoKey;
  used_.clear();

  normals_.prepare(image);
  const int columns = image.rays.columns();
  for (int v = 0; v < image.rays.rows(); ++v) {
    find_ends(image, grid, v);
    normals_.row(v, normal_row_);
    for (int u = 0; u < columns;) {
      const int begin = u;
      do {
        ++u;
      } while (u < columns && u - begin < kLongestRun &&
               row_.same_as_last[static_cast<std::size_t>(u)]);
      add_run(begin, u, window);
    }
  }
}

void RayEnds::find_ends(const RangeImage& image, const VoxelGrid& grid, int v) {
  const RayTable& rays = image.rays;
  const int columns = rays.columns();
  const auto size = static_cast<std::size_t>(columns);
  row_.length_m.resize(size);
  row_.kind.resize(size);
  row_.same_as_last.resize(size);
  const double farthest_m = kFarthestVoxels * grid.voxel_size_m;
  follow_ranges(columns, image.range_m.data() + static_cast<std::size_t>(v) * size, farthest_m,
                std::min(image.limits.max_m, farthest_m), row_.length_m.data(), row_.kind.data());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int a = static_cast<int>(axis);
    const Eigen::Matrix3d& r = image.world_from_sensor;
    row_.end[axis].resize(size);
    end_voxels(
        columns,
        {{r(a, 0), r(a, 1), r(a, 2)}, image.position_m[a], grid.origin_m[a], grid.voxel_size_m},
        row_.length_m.data(), rays.column_sin.data(), rays.column_cos.data(),
        rays.row_sin[static_cast<std::size_t>(v)], rays.row_cos[static_cast<std::size_t>(v)],
        row_.end[axis].data());
  }
  compare_neighbours(columns, row_.end[0].data(), row_.end[1].data(), row_.end[2].data(),
                     row_.kind.data(), row_.same_as_last.data());
}

void RayEnds::add_run(int begin, int end, const MapWindow& window) {
  const auto u = static_cast<std::size_t>(begin);
  const std::int64_t pixels = end - begin;
  const VoxelIndex voxel(row_.end[0][u], row_.end[1][u], row_.end[2][u]);
  switch (static_cast<PixelKind>(row_.kind[u])) {
    case kPoint:
      if (window.contains(voxel)) {
        counts_.points += pixels;
        add_points(begin, end, end_at(voxel, true).seen);
      } else {
        counts_.points_outside += pixels;
        end_at(voxel, false);
      }
      return;
    case kNoReturn:
      counts_.no_returns += pixels;
      end_at(voxel, false);
      return;
    case kInvalid:
      counts_.invalid += pixels;
      return;
  }
}

void RayEnds::add_points(int begin, int end, SurfaceVoxel& seen) const {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;
  std::int32_t count = 0;
  std::int32_t quality = 0;
  for (auto u = static_cast<std::size_t>(begin); u < static_cast<std::size_t>(end); ++u) {
    x += normal_row_.x[u];
    y += normal_row_.y[u];
    z += normal_row_.z[u];
    count += (normal_row_.x[u] | normal_row_.y[u] | normal_row_.z[u]) != 0;
    quality = std::max(quality, normal_row_.quality[u]);
  }
  seen.normal_sum[0] += x;
  seen.normal_sum[1] += y;
  seen.normal_sum[2] += z;
  seen.normal_count += static_cast<std::uint32_t>(count);
  seen.quality = std::max(seen.quality, static_cast<std::uint16_t>(quality));
}

RayEnd& RayEnds::end_at(const VoxelIndex& voxel, bool is_surface) {
  if (2 * ends_.size() >= table_.size()) grow_table();
  const std::uint64_t key = key_of(voxel - sensor_, is_surface);
  const std::size_t mask = table_.size() - 1;
  std::size_t place = first_place(key, table_.size());
  while (table_[place].key != kNoKey && table_[place].key != key) place = (place + 1) & mask;
  if (table_[place].key == kNoKey) {
    table_[place] = {key, static_cast<std::uint32_t>(ends_.size())};
    ends_.push_back({voxel, is_surface, {}});
    used_.push_back(static_cast<std::uint32_t>(place));
  }
  return ends_[table_[place].end];
}

void RayEnds::grow_table() {
  const std::vector<TableEntry> old = table_;
  table_.assign(std::max<std::size_t>(1024, 2 * old.size()), {kNoKey, 0});
  used_.clear();
  const std::size_t mask = table_.size() - 1;
  for (const TableEntry& entry : old) {
    if (entry.key == kNoKey) continue;
    std::size_t place = first_place(entry.key, table_.size());
    while (table_[place].key != kNoKey) place = (place + 1) & mask;
    table_[place] = entry;
    used_.push_back(static_cast<std::uint32_t>(place));
  }
}

std::size_t RayEnds::memory_bytes() const {
  const std::size_t columns = row_.kind.capacity();
  return normals_.memory_bytes() + columns * (sizeof(double) + 9 * sizeof(std::int32_t)) +
         ends_.capacity() * sizeof(RayEnd) + table_.capacity() * sizeof(TableEntry) +
         used_.capacity() * sizeof(std::uint32_t);
}

}  // namespace nextview
