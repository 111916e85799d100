#include "planner/clear_space.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace nextview {

ClearSpace::ClearSpace(const VoxelMap& map, const FeasibilityParameters& parameters)
    : parameters_((parameters.check(), parameters)), grid_(map.grid()), window_(map.window()) {
  const double reach_m = std::max(parameters.clearance_m, parameters.body_radius_m);
  const int margin = 1 + static_cast<int>(std::ceil(reach_m / grid_.voxel_size_m));
  const VoxelIndex sides = window_.size + VoxelIndex::Constant(2 * margin);
  first_ = window_.min - VoxelIndex::Constant(margin);
  stride_ = {1, sides[0], sides[0] * sides[1]};
  const VoxelNearness clearance(parameters.clearance_m, grid_.voxel_size_m);
  near_ = rows_where(clearance.reach(),
                     [&](const VoxelIndex& step) { return clearance.center_is_nearer(step); });
  const VoxelNearness body(parameters.body_radius_m, grid_.voxel_size_m);
  body_ =
      rows_where(body.reach(), [&](const VoxelIndex& step) { return body.box_is_nearer(step); });
  if (cells_of(near_) > kOccupiedMask || cells_of(body_) > kUnknownMask / kUnknown) {
    throw std::invalid_argument(
        "clearance or body radius is too many voxels to plan paths with: choose larger voxels");
  }
  const std::size_t cells =
      static_cast<std::size_t>(stride_[2]) * static_cast<std::size_t>(sides[2]);
  kinds_ = LazyArray(cells, Kind::Unknown);
  against_ = LazyArray(
      cells, kNotEmpty | kBeyondLimits | static_cast<std::uint32_t>(cells_of(body_)) * kUnknown);
  map.for_each_marked(
      [&](std::size_t slot, Label label) { change(map.index_of_slot(slot), kind_of(label)); });
}

template <class IsNearer>
std::vector<ClearSpace::Row> ClearSpace::rows_where(int reach, const IsNearer& is_nearer) const {
  std::vector<Row> rows;
  for (int k = -reach; k <= reach; ++k) {
    for (int j = -reach; j <= reach; ++j) {
      Row row{0, 0};
      for (int i = -reach; i <= reach; ++i) {
        if (!is_nearer(VoxelIndex(i, j, k))) continue;
        if (row.cells++ == 0) row.step = step({i, j, k});
      }
      if (row.cells > 0) rows.push_back(row);
    }
  }
  return rows;
}

std::size_t ClearSpace::cells_of(const std::vector<Row>& rows) {
  std::size_t cells = 0;
  for (const Row& row : rows) cells += static_cast<std::size_t>(row.cells);
  return cells;
}

void ClearSpace::add_around(Cell cell, const std::vector<Row>& rows, std::uint32_t count) {
  for (const Row& row : rows) {
    std::uint32_t* const first = &against_[cell + static_cast<Cell>(row.step)];
    for (int i = 0; i < row.cells; ++i) first[i] += count;
  }
}

ClearSpace::Kind ClearSpace::kind_of(Label label) {
  switch (label) {
    case Label::Unmarked:
    case Label::Occluded:
    case Label::OcclusionPlane:
      return Kind::Unknown;
    case Label::Empty:
      return Kind::Empty;
    case Label::Occupied:
      return Kind::Occupied;
  }
  throw std::logic_error("a label that does not exist");
}

bool ClearSpace::change(const VoxelIndex& index, Kind to) {
  const Cell cell = this->cell(index);
  const Kind from = kinds_[cell];
  if (from == to) return false;
  kinds_[cell] = to;
  if (from == Kind::Unknown && parameters_.within_limits(grid_.center_m(index))) {
    against_[cell] &= ~kBeyondLimits;
  }
  if (from == Kind::Unknown) add_around(cell, body_, ~kUnknown + 1);
  if (to == Kind::Unknown) add_around(cell, body_, kUnknown);
  if (from == Kind::Occupied) add_around(cell, near_, ~kOccupied + 1);
  if (to == Kind::Occupied) add_around(cell, near_, kOccupied);
  if (from == Kind::Empty) against_[cell] |= kNotEmpty;
  if (to == Kind::Empty) against_[cell] &= ~kNotEmpty;
  return true;
}

std::vector<std::uint32_t> ClearSpace::update(const VoxelMap& map,
                                              std::span<const std::uint32_t> changed_slots) {
  std::vector<std::uint32_t> changed;
  for (const std::uint32_t slot : changed_slots) {
    if (change(map.index_of_slot(slot), kind_of(map.labels()[slot]))) changed.push_back(slot);
  }
  return changed;
}

void ClearSpace::block(const Eigen::Vector3d& center_m, double radius_m) {
  const Cell center = cell(grid_.voxel_of(center_m));
  const VoxelNearness ball(std::min(radius_m, parameters_.clearance_m), grid_.voxel_size_m);
  const auto is_inside = [&](const VoxelIndex& step) { return ball.center_is_nearer(step); };
  for (const Row& row : rows_where(ball.reach(), is_inside)) {
    for (int i = 0; i < row.cells; ++i) {
      const Cell cell = center + static_cast<Cell>(row.step + i);
      against_[cell] |= kBlocked;
      blocked_.push_back(cell);
    }
  }
}

void ClearSpace::unblock_all() {
  for (const Cell cell : blocked_) against_[cell] &= ~kBlocked;
  blocked_.clear();
}

std::size_t ClearSpace::memory_bytes() const {
  return kinds_.memory_bytes() + against_.memory_bytes() + blocked_.capacity() * sizeof(Cell);
}

}  // namespace nextview
