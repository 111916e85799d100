#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapper/voxel_grid.h"
#include "sensor/range_image.h"

namespace nextview {

/// No point is sought farther away than this many voxels, nor a range without return believed: it
/// is far outside any window, and a voxel line can still be drawn towards it.
constexpr double kFarthestVoxels = 16384.0;

/// Where the rays of a row end, by column, from column -1 on (whatever stands there) to
/// EndRow::kPadding beyond the last.
struct RowEnds {
  const std::int32_t* voxel[3];
  const std::int32_t* kind;   ///< RangeKind
  const std::int32_t* limit;  ///< where they leave the window: RowEndFinder::voxel_of_limit
};

/// Room for the ends of a row of pixels.
class EndRow {
 public:
  /// RowEnds go on for this many pixels beyond the row, for those who read whole vectors.
  static constexpr int kPadding = 16;

  /// A row as above an image: no ray leaves the window anywhere.
  void assign_none(int columns);

  RowEnds ends() const;
  VoxelIndex voxel(int column) const {
    const std::size_t u = place(column);
    return {end_[0][u], end_[1][u], end_[2][u]};
  }
  RangeKind kind(int column) const { return static_cast<RangeKind>(kind_[place(column)]); }
  std::int32_t limit(int column) const { return limit_[place(column)]; }
  std::size_t memory_bytes() const;

 private:
  friend class RowEndFinder;
  static std::size_t place(int column) { return static_cast<std::size_t>(column) + 1; }

  std::array<std::vector<std::int32_t>, 3> end_;
  std::vector<std::int32_t> kind_;
  std::vector<std::int32_t> limit_;
};

/// Finds, row by row of an image, the voxel of each point (eq. 1 and 2; where there is no return,
/// the voxel up to which the ray is free), and the voxel where its ray leaves the window
/// (limit_of_ray).
class RowEndFinder {
 public:
  /// @param image valid, its sensor inside the window; all three must live as long as this
  RowEndFinder(const RangeImage& image, const VoxelGrid& grid, const MapWindow& window);

  void find(int v, EndRow& row) const;

  /// The voxel that a number of RowEnds::limit stands for: they count the window's voxels, x
  /// fastest.
  VoxelIndex voxel_of_limit(std::int32_t limit) const;

 private:
  const RangeImage& image_;
  const VoxelGrid& grid_;
  const MapWindow& window_;
  Eigen::Matrix3d world_from_lines_;
};

}  // namespace nextview
