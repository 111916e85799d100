#include "planner/shortest_paths.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "planner/segment_walk.h"

namespace nextview {

namespace {

struct Direction {
  VoxelIndex by;
  std::uint32_t length;  // 1/1000 voxel
};

const std::vector<Direction>& directions() {
  static const std::vector<Direction> all = [] {
    constexpr std::array<std::uint32_t, 4> kLength = {0, 1000, 1414, 1732};
    std::vector<Direction> result;
    for (int k = -1; k <= 1; ++k) {
      for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
          const VoxelIndex by(i, j, k);
          if (by != VoxelIndex::Zero()) {
            result.push_back({by, kLength[static_cast<std::size_t>(by.squaredNorm())]});
          }
        }
      }
    }
    return result;
  }();
  return all;
}

constexpr std::uint8_t kStart = 26;  // where no step has led
// More than the longest step, so that cells of different lengths never share a bucket.
constexpr std::uint32_t kBuckets = 2048;

}  // namespace

void ShortestPaths::stand_at(const ClearSpace& space, const VoxelMap& map,
                             const Eigen::Vector3d& present_m, double departure_m) {
  const VoxelIndex present = space.grid().voxel_of(present_m);
  if (!space.window().contains(present)) {
    throw std::invalid_argument("the sensor stands outside the map's window");
  }
  space_ = &space;
  present_m_ = present_m;
  for (const Cell cell : has_length_) lengths_[cell] = kNoLength;
  has_length_.clear();
  buckets_.resize(kBuckets);
  for (std::vector<Cell>& bucket : buckets_) bucket.clear();
  for (const Cell cell : exempted_) passage_[cell] = Passage::AsClear;
  exempted_.clear();
  if (lengths_.size() != space.cells()) {
    lengths_ = LazyArray(space.cells(), std::uint32_t{kNoLength});
    arrived_ = LazyArray<std::uint8_t>(space.cells());
    passage_ = LazyArray(space.cells(), Passage::AsClear);
  }
  reached_.clear();
  exempt_around(map, present, departure_m);
  const Cell start = space.cell(present);
  lengths_[start] = 0;
  arrived_[start] = kStart;
  has_length_.push_back(start);
  buckets_[0].push_back(start);
  waiting_ = 1;
  next_length_ = 0;
}

bool ShortestPaths::may_be_at(const Eigen::Vector3d& position_m) const {
  const VoxelIndex voxel = space_->grid().voxel_of(position_m);
  return space_->window().contains(voxel) && may_pass(space_->cell(voxel));
}

int ShortestPaths::nearest_occupied(const VoxelMap& map, const VoxelIndex& voxel, int limit) const {
  int nearest = limit;
  const int reach = static_cast<int>(std::ceil(std::sqrt(limit)));
  for (int k = -reach; k <= reach; ++k) {
    for (int j = -reach; j <= reach; ++j) {
      for (int i = -reach; i <= reach; ++i) {
        const VoxelIndex step(i, j, k);
        if (step.squaredNorm() < nearest && map.label(voxel + step) == Label::Occupied) {
          nearest = step.squaredNorm();
        }
      }
    }
  }
  return nearest;
}

void ShortestPaths::exempt_around(const VoxelMap& map, const VoxelIndex& present,
                                  double departure_m) {
  const FeasibilityParameters& parameters = space_->parameters();
  const double voxel_m = space_->grid().voxel_size_m;
  const int clear = VoxelNearness(parameters.clearance_m, voxel_m).center_limit();
  const VoxelNearness body(parameters.body_radius_m, voxel_m);
  const VoxelNearness departure(departure_m, voxel_m);
  const int body_reach = body.reach();
  std::vector<VoxelIndex> of_body;
  for (int k = -body_reach; k <= body_reach; ++k) {
    for (int j = -body_reach; j <= body_reach; ++j) {
      for (int i = -body_reach; i <= body_reach; ++i) {
        if (body.box_is_nearer({i, j, k})) of_body.push_back({i, j, k});
      }
    }
  }
  // Beyond this no voxel can have an unknown one within the departure in its body.
  const int reach = departure.reach() + body_reach;
  const int at_present = nearest_occupied(map, present, clear);
  double body_voxels = 0.0;
  for (const VoxelIndex& step : of_body) {
    body_voxels = std::max(body_voxels, std::sqrt(step.squaredNorm()));
  }
  const double departure_voxels = std::sqrt(departure.center_limit());
  const auto unknown_near = [&](const VoxelIndex& voxel) {
    const double from_present = std::sqrt((voxel - present).squaredNorm());
    if (from_present + body_voxels < departure_voxels) return false;  // all of it is exempt
    return std::ranges::any_of(of_body, [&](const VoxelIndex& step) {
      if (departure.center_is_nearer(voxel + step - present)) return false;
      const Label label = map.label(voxel + step);
      return label != Label::Empty && label != Label::Occupied;
    });
  };
  // Whether something Occupied is nearer than at the present position. Where nothing is within the
  // clearance there, the space's own counts say so without a search.
  const auto occupied_nearer = [&](const VoxelIndex& voxel, Cell cell) {
    return space_->is_occupied_near(cell) &&
           (at_present == clear || nearest_occupied(map, voxel, at_present) < at_present);
  };
  for (int k = -reach; k <= reach; ++k) {
    for (int j = -reach; j <= reach; ++j) {
      for (int i = -reach; i <= reach; ++i) {
        const VoxelIndex voxel = present + VoxelIndex(i, j, k);
        if (!space_->window().contains(voxel)) continue;
        const Cell cell = space_->cell(voxel);
        if (space_->is_clear(cell)) continue;
        if (voxel != present) {
          if (!space_->is_empty(cell) || !space_->is_within_limits(cell) ||
              space_->is_blocked(cell)) {
            continue;
          }
          if (occupied_nearer(voxel, cell) || unknown_near(voxel)) continue;
        }
        passage_[cell] = space_->is_occupied_near(cell) ? Passage::Departing : Passage::Exempt;
        exempted_.push_back(cell);
      }
    }
  }
}

template <class IsWanted>
void ShortestPaths::find_while(const IsWanted& is_wanted) {
  std::array<int, 26> step;
  for (std::size_t d = 0; d < step.size(); ++d) step[d] = space_->step(directions()[d].by);
  for (; waiting_ > 0 && is_wanted(); ++next_length_) {
    std::vector<Cell>& bucket = buckets_[next_length_ % kBuckets];
    // No step is so long that it would lead into the same bucket, nor of no length.
    for (const Cell cell : bucket) {
      --waiting_;
      if (lengths_[cell] != next_length_) continue;  // found again on a shorter path
      reached_.push_back(space_->index(cell));
      for (std::size_t d = 0; d < step.size(); ++d) {
        const Cell next = cell + static_cast<Cell>(step[d]);
        const std::uint32_t length = next_length_ + directions()[d].length;
        if (lengths_[next] <= length || !may_step(cell, next)) continue;
        if (lengths_[next] == kNoLength) has_length_.push_back(next);
        lengths_[next] = length;
        arrived_[next] = static_cast<std::uint8_t>(d);
        buckets_[length % kBuckets].push_back(next);
        ++waiting_;
      }
    }
    bucket.clear();
  }
}

void ShortestPaths::find_all() {
  find_while([] { return true; });
}

void ShortestPaths::find_as_far_as(const VoxelIndex& voxel) {
  if (!space_->window().contains(voxel)) return;
  const Cell cell = space_->cell(voxel);
  find_while([&] { return lengths_[cell] >= next_length_; });
}

double ShortestPaths::length_m(const VoxelIndex& voxel) const {
  if (!space_->window().contains(voxel)) return kUnreachable;
  const std::uint32_t length = lengths_[space_->cell(voxel)];
  return length < next_length_ ? length * 1e-3 * space_->grid().voxel_size_m : kUnreachable;
}

bool ShortestPaths::straight_is_clear(const Eigen::Vector3d& from_m,
                                      const Eigen::Vector3d& to_m) const {
  SegmentWalk walk(space_->grid(), from_m, to_m);
  Cell last = space_->cell(walk.voxel());
  while (!walk.at_end()) {
    walk.step();
    const Cell cell = space_->cell(walk.voxel());
    if (!may_step(last, cell)) return false;
    last = cell;
  }
  return true;
}

std::vector<Eigen::Vector3d> ShortestPaths::waypoints_m(const VoxelIndex& voxel,
                                                        const Eigen::Vector3d& end_m) const {
  std::vector<Eigen::Vector3d> path = {end_m};
  for (Cell cell = space_->cell(voxel); arrived_[cell] != kStart;) {
    cell -= static_cast<Cell>(space_->step(directions()[arrived_[cell]].by));
    path.push_back(space_->grid().center_m(space_->index(cell)));
  }
  path.back() = present_m_;
  std::ranges::reverse(path);
  // A corner is left out when the piece past it is clear too.
  std::vector<Eigen::Vector3d> corners = {path.front()};
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    if (!straight_is_clear(corners.back(), path[i + 1])) corners.push_back(path[i]);
  }
  if (path.size() > 1) corners.push_back(path.back());
  return corners;
}

}  // namespace nextview
