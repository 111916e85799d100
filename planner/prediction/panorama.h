#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "planner/prediction/free_space_field.h"
#include "planner/prediction/orientations.h"
#include "planner/prediction/ray_kernel.h"
#include "sensor/sensor_geometry.h"

namespace nextview {

/// The directions around a point as the cells of a cube's faces, kSide x kSide each, evenly spaced
/// in angle: 90 / 64 = 1.4 degrees a cell. Cells are numbered by face (2 axis + (sign < 0)), then
/// row, then column.
class Panorama {
 public:
  static constexpr int kSide = 64;
  static constexpr int kRows = 6 * kSide;
  static constexpr int kCells = kRows * kSide;

  /// The direction of a cell's middle, a unit vector of the world frame.
  static Eigen::Vector3d direction(int cell);

  /// One ray for every cell.
  /// @param reach of the rays, in voxels; 1 to IntegerLine::kMaxSteps
  explicit Panorama(double reach);

  /// Casts them from a voxel: for each cell the field's offset of the voxel that its ray meets
  /// first, or -1 when it meets only what may be jumped over.
  void cast(const FreeSpaceField& field, const VoxelIndex& sensor,
            std::span<std::int32_t> met_at) const;

 private:
  std::array<RayBundle, 6> faces_;
};

/// For views of many orientations sums over the panorama's cells that lie in them. A view is a set
/// of runs of neighbouring cells in a row; with the sums of each row up to each of its cells, a run
/// is one difference.
class PanoramaViews {
 public:
  /// Whose views: a sensor's, which sees what lies between its first and its last column and row,
  /// and half a pixel beyond.
  PanoramaViews(const RayTable& rays, std::span<const Orientation> orientations);

  std::size_t size() const { return begins_.size() - 1; }
  int cells(std::size_t view) const { return cells_[view]; }

  /// Sums of values from each row's first cell up to each of its cells.
  using RowSums = std::array<std::int32_t, Panorama::kRows*(Panorama::kSide + 1)>;
  static void sum_rows(std::span<const std::int32_t> values, RowSums& sums);
  /// The sum of the values of a view's cells.
  std::int32_t sum(const RowSums& sums, std::size_t view) const {
    std::int32_t total = 0;
    for (std::size_t i = begins_[view]; i < begins_[view + 1]; ++i) {
      total += sums[runs_[i].end] - sums[runs_[i].begin];
    }
    return total;
  }
  /// The cells of a view.
  template <class Visit>
  void for_each_cell(std::size_t view, Visit visit) const {
    for (std::size_t i = begins_[view]; i < begins_[view + 1]; ++i) {
      const int row = runs_[i].begin / (Panorama::kSide + 1);
      // Each row has one sum more than it has cells.
      for (int at = runs_[i].begin; at < runs_[i].end; ++at) visit(at - row);
    }
  }

 private:
  struct Run {  // of sums
    std::uint16_t begin;
    std::uint16_t end;
  };
  std::vector<Run> runs_;
  std::vector<std::size_t> begins_;  // of each view's runs, and the end
  std::vector<int> cells_;           // by view
};

}  // namespace nextview
