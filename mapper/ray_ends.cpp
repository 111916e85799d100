#include "mapper/ray_ends.h"

#include <algorithm>
#include <utility>

namespace nextview {

namespace {

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
  const RowEndFinder finder(image, grid, window);
  row_above_.assign_none(columns);
  row_.assign_none(columns);
  for (int v = 0; v < image.rays.rows(); ++v) {
    finder.find(v, row_);
    normals_.row(v, normal_row_);
    const RowEnds ends = row_.ends();
    for (const PixelRun& run : runs_.find(columns, ends, normal_row_)) add_run(run, window);
    for (const std::int32_t column : runs_.find_other_lines(columns, ends, row_above_.ends())) {
      add_shadow(column, finder);
    }
    end_above_.swap(end_here_);
    std::swap(row_, row_above_);
  }
}

void RayEnds::add_run(const PixelRun& run, const MapWindow& window) {
  const std::int64_t pixels = run.end - run.begin;
  const VoxelIndex voxel = row_.voxel(run.begin);
  switch (row_.kind(run.begin)) {
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

void RayEnds::add_shadow(int column, const RowEndFinder& finder) {
  if (row_.kind(column) != RangeKind::Point) return;
  const std::uint32_t end = end_here_[static_cast<std::size_t>(column)];
  if (!ends_[end].is_surface) return;
  const std::int32_t limit = row_.limit(column);
  const std::uint64_t key = std::uint64_t{end} << 32 | static_cast<std::uint32_t>(limit);
  if (shadow_numbers_.number_of(key) < shadows_.size()) return;
  shadows_.push_back({end, finder.voxel_of_limit(limit)});
}

std::size_t RayEnds::memory_bytes() const {
  const std::size_t numbers = end_above_.capacity() + end_here_.capacity();
  return normals_.memory_bytes() + row_.memory_bytes() + row_above_.memory_bytes() +
         runs_.memory_bytes() + numbers_.memory_bytes() + numbers * sizeof(std::uint32_t) +
         ends_.capacity() * sizeof(RayEnd) + shadow_numbers_.memory_bytes() +
         shadows_.capacity() * sizeof(Shadow);
}

}  // namespace nextview
