#include "mapper/ray_ends.h"

#include <algorithm>
#include <cmath>

namespace nextview {

namespace {

// An end as a key: its voxel relative to the sensor's, 16 bits an axis, and whether it is a
// surface. Ends lie within kFarthestVoxels of the sensor, so 16 bits hold them.
constexpr int kAxisBits = 16;
constexpr std::uint64_t kSurfaceBit = std::uint64_t{1} << (3 * kAxisBits);
constexpr std::uint64_t kNoEnd = ~std::uint64_t{0};
constexpr std::int32_t kBias = 1 << (kAxisBits - 1);

VoxelIndex displacement_of(std::uint64_t key) {
  VoxelIndex displacement;
  for (int axis = 0; axis < 3; ++axis) {
    const auto bits = static_cast<std::int32_t>(key >> (axis * kAxisBits) & 0xffff);
    displacement[axis] = bits - kBias;
  }
  return displacement;
}

std::size_t scramble(std::uint64_t key) {
  const std::uint64_t product = key * 0x9e3779b97f4a7c15u;
  return static_cast<std::size_t>(product >> 32);
}

// Eq. 1 and 2 along a row of pixels, in plain arrays of numbers.
class RowOfPoints {
 public:
  RowOfPoints(const RangeImage& image, const VoxelGrid& grid, const MapWindow& window)
      : image_(image), grid_(grid), window_(window), sensor_(grid.voxel_of(image.position_m)) {
    farthest_m_ = kFarthestVoxels * grid.voxel_size_m;
    clear_m_ = std::min(image.limits.max_m, farthest_m_);
  }

  // Writes the key of every pixel of row v, and counts them.
  void keys(int v, std::uint64_t* keys, PixelCounts& counts) const;

 private:
  const RangeImage& image_;
  const VoxelGrid& grid_;
  const MapWindow& window_;
  VoxelIndex sensor_;
  double farthest_m_;  ///< where points farther away are taken to be
  double clear_m_;     ///< how far a ray without return is believed free
};

void RowOfPoints::keys(int v, std::uint64_t* keys, PixelCounts& counts) const {
  const RayTable& rays = image_.rays;
  const int columns = rays.columns();
  const float* const range = image_.range_m.data() + static_cast<std::ptrdiff_t>(v) * columns;
  const double* const column_sin = rays.column_sin.data();
  const double* const column_cos = rays.column_cos.data();
  const double row_sin = rays.row_sin[static_cast<std::size_t>(v)];
  const double row_cos = rays.row_cos[static_cast<std::size_t>(v)];
  const Eigen::Matrix3d& r = image_.world_from_sensor;
  std::int64_t surfaces = 0;
  std::int64_t finite = 0;
  std::int64_t no_returns = 0;
  for (int u = 0; u < columns; ++u) {
    const float d = range[u];
    const bool is_finite = d <= std::numeric_limits<float>::max();
    const bool is_no_return = d > std::numeric_limits<float>::max();
    const double point_m = is_finite ? std::min(static_cast<double>(d), farthest_m_) : 0.0;
    const double length_m = is_no_return ? clear_m_ : point_m;
    const double n[3] = {-column_sin[u], column_cos[u] * row_cos, column_cos[u] * row_sin};
    std::uint64_t key = 0;
    bool inside = true;
    for (int axis = 0; axis < 3; ++axis) {
      const double direction = r(axis, 0) * n[0] + r(axis, 1) * n[1] + r(axis, 2) * n[2];
      const double x = image_.position_m[axis] + length_m * direction;  // eq. 1
      const double relative = x - grid_.origin_m[axis];
      const double half = std::copysign(0.5 * grid_.voxel_size_m, relative);
      const auto index =
          static_cast<std::int32_t>((relative + half) / grid_.voxel_size_m);  // eq. 2
      inside &= static_cast<std::uint32_t>(index - window_.min[axis]) <
                static_cast<std::uint32_t>(window_.size[axis]);
      key |= static_cast<std::uint64_t>(index - sensor_[axis] + kBias) << (axis * kAxisBits);
    }
    const bool is_surface = is_finite && inside;
    key |= is_surface ? kSurfaceBit : 0;
    keys[u] = is_finite || is_no_return ? key : kNoEnd;
    surfaces += is_surface;
    finite += is_finite;
    no_returns += is_no_return;
  }
  counts.points += surfaces;
  counts.points_outside += finite - surfaces;
  counts.no_returns += no_returns;
  counts.invalid += columns - finite - no_returns;
}

}  // namespace

void RayEnds::collect(const RangeImage& image, const VoxelGrid& grid, const MapWindow& window) {
  sensor_ = grid.voxel_of(image.position_m);
  counts_ = {};
  ends_.clear();
  clear_table();
  const int columns = image.rays.columns();
  key_row_.resize(static_cast<std::size_t>(columns));
  const RowOfPoints points(image, grid, window);
  normals_.prepare(image);
  for (int v = 0; v < image.rays.rows(); ++v) {
    points.keys(v, key_row_.data(), counts_);
    normals_.row(v, normal_row_);
    for (int u = 0; u < columns;) {
      const std::uint64_t key = key_row_[static_cast<std::size_t>(u)];
      const int begin = u;
      do {
        ++u;
      } while (u < columns && key_row_[static_cast<std::size_t>(u)] == key);
      if (key == kNoEnd) continue;
      RayEnd& end = end_of(key);
      if (end.is_surface) add_points(begin, u, end.seen);
    }
  }
}

void RayEnds::add_points(int begin, int end, SurfaceVoxel& seen) const {
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int64_t z = 0;
  std::uint32_t count = 0;
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
  seen.normal_count += count;
  seen.quality = std::max(seen.quality, static_cast<std::uint16_t>(quality));
}

RayEnd& RayEnds::end_of(std::uint64_t key) {
  if (2 * ends_.size() >= table_.size()) grow_table();
  const std::size_t mask = table_.size() - 1;
  std::size_t place = scramble(key) & mask;
  while (table_[place].key != kNoEnd && table_[place].key != key) place = (place + 1) & mask;
  if (table_[place].key == kNoEnd) {
    table_[place] = {key, static_cast<std::uint32_t>(ends_.size())};
    ends_.push_back({sensor_ + displacement_of(key), (key & kSurfaceBit) != 0, {}});
    used_.push_back(static_cast<std::uint32_t>(place));
  }
  return ends_[table_[place].end];
}

void RayEnds::grow_table() {
  const std::vector<TableEntry> old = table_;
  table_.assign(std::max<std::size_t>(1024, 2 * old.size()), {kNoEnd, 0});
  used_.clear();
  const std::size_t mask = table_.size() - 1;
  for (const TableEntry& entry : old) {
    if (entry.key == kNoEnd) continue;
    std::size_t place = scramble(entry.key) & mask;
    while (table_[place].key != kNoEnd) place = (place + 1) & mask;
    table_[place] = entry;
    used_.push_back(static_cast<std::uint32_t>(place));
  }
}

void RayEnds::clear_table() {
  for (const std::uint32_t place : used_) table_[place].key = kNoEnd;
  used_.clear();
}

std::size_t RayEnds::memory_bytes() const {
  return normals_.memory_bytes() + key_row_.capacity() * sizeof(std::uint64_t) +
         4 * normal_row_.x.capacity() * sizeof(std::int32_t) + ends_.capacity() * sizeof(RayEnd) +
         table_.capacity() * sizeof(TableEntry) + used_.capacity() * sizeof(std::uint32_t);
}

}  // namespace nextview
