#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "mapper/lazy_array.h"
#include "mapper/voxel_map.h"
#include "planner/feasibility.h"

namespace nextview {

/// Every voxel of a map's window at which the robot may be (P19 and the body rule of
/// feasibility.h), kept in step with the map.
///
/// A voxel is clear when it is Empty, lies inside workspace and lift limits, has no Occupied
/// voxel's centre nearer than the clearance and no unknown one's box nearer than the body's radius,
/// and is not blocked. For each voxel it is counted what speaks against it, in one word:
///
///     Occupied voxels within the clearance | unknown ones within the body | three reasons more
///
/// A voxel that changes its label changes the counts around it, so an update costs what the range
/// image changed, whatever the size of the map, and memory what has been seen of it. Cells are the
/// window's voxels and a margin around it that is never clear, so that neighbours are fixed
/// distances away and nobody asks for the border.
class ClearSpace {
 public:
  /// Of a whole map.
  /// @throws std::invalid_argument for parameters that cannot be, or when so many voxels lie within
  ///         clearance or body that they cannot be counted
  ClearSpace(const VoxelMap& map, const FeasibilityParameters& parameters);

  /// Follows the map after a change of the labels at these slots (and of no others).
  /// @return those of them that are unknown, Empty or Occupied and were not so before
  std::vector<std::uint32_t> update(const VoxelMap& map,
                                    std::span<const std::uint32_t> changed_slots);

  /// Keeps the robot out of a ball, whose cells are not clear until it is unblocked.
  void block(const Eigen::Vector3d& center_m, double radius_m);
  void unblock_all();

  const FeasibilityParameters& parameters() const { return parameters_; }
  const VoxelGrid& grid() const { return grid_; }
  const MapWindow& window() const { return window_; }

  using Cell = std::uint32_t;
  std::size_t cells() const { return against_.size(); }
  /// Valid for the window's voxels and those of the margin.
  Cell cell(const VoxelIndex& index) const {
    const VoxelIndex at = index - first_;
    return static_cast<Cell>(at[0] + stride_[1] * at[1] + stride_[2] * at[2]);
  }
  VoxelIndex index(Cell cell) const {
    const auto c = static_cast<int>(cell);
    return first_ + VoxelIndex(c % stride_[1], c % stride_[2] / stride_[1], c / stride_[2]);
  }
  /// What a step adds to a cell.
  int step(const VoxelIndex& by) const { return by[0] + stride_[1] * by[1] + stride_[2] * by[2]; }

  bool is_clear(Cell cell) const { return against_[cell] == 0; }
  bool is_clear(const VoxelIndex& index) const {
    return window_.contains(index) && is_clear(cell(index));
  }
  bool is_empty(Cell cell) const { return (against_[cell] & kNotEmpty) == 0; }
  /// Of a voxel that is known; of others nobody has asked the limits.
  bool is_within_limits(Cell cell) const { return (against_[cell] & kBeyondLimits) == 0; }
  bool is_blocked(Cell cell) const { return (against_[cell] & kBlocked) != 0; }
  bool is_occupied_near(Cell cell) const { return (against_[cell] & kOccupiedMask) != 0; }
  /// Whether nothing but the limits speaks against a cell.
  bool is_clear_beyond_limits(Cell cell) const { return against_[cell] == kBeyondLimits; }

  std::size_t memory_bytes() const;

 private:
  enum class Kind : std::uint8_t { Unknown, Empty, Occupied };
  static constexpr std::uint32_t kOccupied = 1;  // one Occupied voxel nearer than the clearance
  static constexpr std::uint32_t kOccupiedMask = (1 << 16) - 1;
  static constexpr std::uint32_t kUnknown = 1 << 16;  // one unknown voxel nearer than the body
  static constexpr std::uint32_t kUnknownMask = ((1 << 13) - 1) << 16;
  static constexpr std::uint32_t kNotEmpty = 1u << 29;
  static constexpr std::uint32_t kBeyondLimits = 1u << 30;
  static constexpr std::uint32_t kBlocked = 1u << 31;

  static Kind kind_of(Label label);
  bool change(const VoxelIndex& index, Kind to);
  /// Cells beside one another along x, as seen from a cell.
  struct Row {
    int step;  // to the first
    int cells;
  };
  template <class IsNearer>
  std::vector<Row> rows_where(int reach, const IsNearer& is_nearer) const;
  static std::size_t cells_of(const std::vector<Row>& rows);
  void add_around(Cell cell, const std::vector<Row>& rows, std::uint32_t count);

  FeasibilityParameters parameters_;
  VoxelGrid grid_;
  MapWindow window_;
  VoxelIndex first_;       // of the cells
  VoxelIndex stride_;      // between cells along x, y, z
  std::vector<Row> near_;  // all cells whose centre is nearer than the clearance
  std::vector<Row> body_;  // and those whose box is nearer than the body's radius
  LazyArray<Kind> kinds_;
  LazyArray<std::uint32_t> against_;
  std::vector<Cell> blocked_;
};

}  // namespace nextview
