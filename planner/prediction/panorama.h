#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
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

  /// A set of cells: a bit for each, cell i in bit i % kSide of row i / kSide.
  using Cells = std::array<std::uint64_t, kRows>;
  static_assert(kSide == 64);
  /// What cells' rays meet.
  struct Met {
    std::vector<std::int32_t> at = std::vector<std::int32_t>(kCells, -1);  ///< the field's offset
    Cells occupied{};  ///< cells that meet kOccupied,
    Cells plane{};     ///< kOcclusionPlane,
    Cells unseen{};    ///< and kUnseen
  };
  /// Cells are cast by so many at a time, neighbours in a row. A set of such packets: packet i in
  /// bit i % 64 of word i / 64.
  static constexpr std::size_t kPacketCells = RayBundle::kPacketRays;
  using Packets = std::array<std::uint64_t, kCells / kPacketCells / 64>;
  static Packets all_packets();
  static Packets with_any(const Cells& cells);  ///< packets in which there are any of the cells
  static Packets with_all(const Cells& cells);  ///< of which all cells are in the set
  static void add_all(const Packets& packets, Cells& cells);

  /// Casts the rays of some packets from a voxel. Of cells that meet only what may be jumped over
  /// the offset is -1; of cells that are not cast it stays as it is, and they are in no set.
  void cast(const FreeSpaceField& field, const VoxelIndex& sensor, const Packets& packets,
            Met& met) const;

  /// Adds all packets of which a ray may pass the voxel so many voxels from where it starts, and
  /// maybe some beside them.
  static void add_passing(const VoxelIndex& step, Packets& packets);

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

  /// How many of a view's cells are in a set.
  int count(const Panorama::Cells& cells, std::size_t view) const {
    int total = 0;
    for (std::size_t i = begins_[view]; i < begins_[view + 1]; ++i) {
      const Run& run = runs_[i];
      const int row = run.begin / (Panorama::kSide + 1);
      const int first = run.begin - row * (Panorama::kSide + 1);
      const std::uint64_t in_run = ~std::uint64_t{0} >> (Panorama::kSide - (run.end - run.begin))
                                                            << first;
      total += std::popcount(cells[static_cast<std::size_t>(row)] & in_run);
    }
    return total;
  }

  /// Sums of values from each row's first cell up to each of its cells.
  using RowSums = std::array<std::int32_t, Panorama::kRows*(Panorama::kSide + 1)>;
  /// Fills in the sums of one row.
  static void sum_no_cells(std::size_t row, RowSums& sums) {
    std::fill_n(&sums[row * (Panorama::kSide + 1)], Panorama::kSide + 1, 0);
  }
  static void sum_row(const std::array<std::int32_t, Panorama::kSide>& values, std::size_t row,
                      RowSums& sums) {
    std::int32_t total = 0;
    std::int32_t* sum = &sums[row * (Panorama::kSide + 1)];
    *sum++ = 0;
    for (const std::int32_t value : values) *sum++ = total += value;
  }
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
