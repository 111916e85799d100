#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "mapper/lazy_array.h"
#include "planner/clear_space.h"

namespace nextview {

/// The shortest paths from where the robot is to every position it can get to through clear space.
///
/// Paths lead over the voxel grid, from a voxel to any of the 26 around it, and their lengths are
/// real ones (1, sqrt 2, sqrt 3 voxels, to 1/1000). Both ends of a step are clear; between two
/// clear voxels nothing can be nearer than an eighth of a voxel less than at them.
///
/// Where the robot stands more is allowed, for it is there: unknown voxels nearer to it than the
/// departure do not count, and when something turned out to be within the clearance the path may
/// begin there, but must not come nearer to anything Occupied than the present position is, and
/// once it has got clear it must stay so.
class ShortestPaths {
 public:
  static constexpr double kUnreachable = std::numeric_limits<double>::infinity();

  /// Stands at a position, from which no path is known yet but the straight ones; to be called
  /// again whenever the space has changed. Space and map must stay as they are until then.
  /// @param departure_m unknown voxels nearer to the present one do not count
  /// @throws std::invalid_argument when the present position lies outside the window
  void stand_at(const ClearSpace& space, const VoxelMap& map, const Eigen::Vector3d& present_m,
                double departure_m);
  /// Finds the paths to all positions from where it stands, by Dijkstra's method, unless it has.
  void find_all();
  /// Finds the shortest of them, up to that to a voxel; all when none leads there.
  void find_as_far_as(const VoxelIndex& voxel);
  /// Both.
  void find(const ClearSpace& space, const VoxelMap& map, const Eigen::Vector3d& present_m,
            double departure_m) {
    stand_at(space, map, present_m, departure_m);
    find_all();
  }

  /// Whether the robot may be at a position, if a path leads there.
  bool may_be_at(const Eigen::Vector3d& position_m) const;
  /// Whether the straight path from where it stands to such a position is clear. The answer does
  /// not need the others to have been found.
  bool leads_straight_to(const Eigen::Vector3d& position_m) const {
    return straight_is_clear(present_m_, position_m);
  }

  /// The length of the path to a voxel, or kUnreachable when none has been found.
  double length_m(const VoxelIndex& voxel) const;
  /// Voxels with a path that has been found, the present one included, nearest first.
  const std::vector<VoxelIndex>& reached() const { return reached_; }

  /// The path to a voxel that has one: the present position, the corners, the voxel's centre. Of
  /// the voxels between two of them, which a straight piece leads through, each may be passed.
  std::vector<Eigen::Vector3d> waypoints_m(const VoxelIndex& voxel) const {
    return waypoints_m(voxel, space_->grid().center_m(voxel));
  }
  /// The same to a position straight ahead, or in a voxel that has a path.
  std::vector<Eigen::Vector3d> waypoints_to_m(const Eigen::Vector3d& position_m) const {
    if (leads_straight_to(position_m)) return {present_m_, position_m};
    return waypoints_m(space_->grid().voxel_of(position_m), position_m);
  }

  /// Of what is kept for each cell.
  std::size_t memory_bytes() const {
    return lengths_.memory_bytes() + arrived_.memory_bytes() + passage_.memory_bytes();
  }

 private:
  using Cell = ClearSpace::Cell;
  // How a cell may be passed.
  enum class Passage : std::uint8_t {
    AsClear,    // as the space says
    Exempt,     // clear but for unknown voxels within the departure
    Departing,  // within the clearance, no nearer to anything than the present position
  };
  static constexpr std::uint32_t kNoLength = 0xffffffff;

  void exempt_around(const VoxelMap& map, const VoxelIndex& present, double departure_m);
  int nearest_occupied(const VoxelMap& map, const VoxelIndex& voxel, int limit) const;
  bool may_pass(Cell cell) const {
    return space_->is_clear(cell) || passage_[cell] != Passage::AsClear;
  }
  // From a cell that may be passed to the next.
  bool may_step(Cell from, Cell to) const {
    return may_pass(to) &&
           (passage_[to] != Passage::Departing || passage_[from] == Passage::Departing);
  }
  /// Goes on with the search for as long as it is wanted and there is something to find.
  template <class IsWanted>
  void find_while(const IsWanted& is_wanted);
  std::vector<Eigen::Vector3d> waypoints_m(const VoxelIndex& voxel,
                                           const Eigen::Vector3d& end_m) const;
  bool straight_is_clear(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) const;

  const ClearSpace* space_ = nullptr;
  Eigen::Vector3d present_m_ = Eigen::Vector3d::Zero();
  // By cell, 1/1000 voxel: final below next_length_, from there on the shortest so far.
  LazyArray<std::uint32_t> lengths_;
  LazyArray<std::uint8_t> arrived_;  // by cell: the direction of the last step there
  LazyArray<Passage> passage_;       // by cell
  std::vector<Cell> exempted_;
  std::vector<VoxelIndex> reached_;
  std::vector<Cell> has_length_;
  std::vector<std::vector<Cell>> buckets_;  // cells still to be left, by length
  std::size_t waiting_ = 0;                 // in the buckets
  std::uint32_t next_length_ = 0;           // of the first bucket
};

}  // namespace nextview
