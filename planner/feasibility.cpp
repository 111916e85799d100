#include "planner/feasibility.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include <string>

#include "lcmtypes/parameter_bounds.h"

#include "planner/segment_walk.h"

namespace nextview {

namespace {

void require(bool holds, const char* parameter, const char* rule) {
  if (!holds) throw std::invalid_argument(std::string(parameter) + " must be " + rule);
}

// The least squared distance, in whole voxels, that is not nearer than a length.
int squared_voxels(double length_m, double voxel_size_m) {
  const double voxels = length_m / voxel_size_m;
  // 0.3 / 0.1 is a little below 3: a length of whole voxels must not lose one to rounding.
  return static_cast<int>(std::ceil(voxels * voxels - 1e-6));
}

double distance_to_segment(const Eigen::Vector3d& point, const Eigen::Vector3d& from,
                           const Eigen::Vector3d& to) {
  const Eigen::Vector3d along = to - from;
  const double squared_length = along.squaredNorm();
  const double t =
      squared_length > 0.0 ? std::clamp((point - from).dot(along) / squared_length, 0.0, 1.0) : 0.0;
  return (from + t * along - point).norm();
}

}  // namespace

void FeasibilityParameters::check() const {
  bounds::kClearance.require(clearance_m);
  if (body_radius_m != 0.0) bounds::kBodyRadius.require(body_radius_m);
  bounds::kDeparture.require(departure_m);
  for (int axis = 0; axis < 3; ++axis) {
    require(workspace_min_m[axis] < workspace_max_m[axis], "workspace_min_m",
            "below workspace_max_m on every axis");
  }
  require(lift_min_m <= lift_max_m, "lift_min_m", "at most lift_max_m");
}

FeasibleSpace::FeasibleSpace(const VoxelMap& map, const FeasibilityParameters& parameters,
                             const Eigen::Vector3d& present_m, std::span<const SensorPose> refused,
                             const FreeSpaceField* field)
    : map_(map), parameters_(parameters), present_m_(present_m), field_(field) {
  parameters.check();
  present_ = map.grid().voxel_of(present_m);
  if (!map.contains(present_)) {
    throw std::invalid_argument("the sensor stands outside the map's window");
  }
  for (const SensorPose& pose : refused) refused_m_.push_back(pose.position_m);

  const double voxel_size_m = map.grid().voxel_size_m;
  clear_ = squared_voxels(parameters.clearance_m, voxel_size_m);
  body_ = squared_voxels(parameters.body_radius_m, voxel_size_m);
  departure_ = squared_voxels(parameters.departure_m, voxel_size_m);
  const int limit = std::max(clear_, body_);
  reach_ = 0;
  while ((reach_ + 1) * (reach_ + 1) < limit) ++reach_;
  make_offsets(limit);
  at_present_ = surroundings(present_, nullptr);
}

void FeasibleSpace::make_offsets(int limit) {
  for (int shell = 0; shell <= reach_; ++shell) {
    for (int k = -shell; k <= shell; ++k) {
      for (int j = -shell; j <= shell; ++j) {
        const bool inside = std::max(std::abs(k), std::abs(j)) < shell;
        for (int i = -shell; i <= shell; i += inside ? 2 * shell : 1) {
          const int squared_length = i * i + j * j + k * k;
          if (squared_length < limit) offsets_.push_back({{i, j, k}, squared_length, shell});
        }
      }
    }
  }
  for (const Offset& offset : offsets_) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const int sign : {-1, 1}) {
        // Squared length as seen from the voxel the step came from.
        const int before = offset.squared_length + 2 * sign * offset.step[axis] + 1;
        const bool enters_clearance = offset.squared_length < clear_ && before >= clear_;
        const bool enters_body = offset.squared_length < body_ && before >= body_;
        if (enters_clearance || enters_body) entered_by(axis, sign).push_back(offset);
      }
    }
  }
}

bool FeasibleSpace::reachable(const Eigen::Vector3d& position_m) {
  return within_limits(position_m) && !is_refused(position_m) && path_clear(position_m);
}

bool FeasibleSpace::within_limits(const Eigen::Vector3d& position_m) const {
  return position_m.allFinite() &&
         (position_m.array() >= parameters_.workspace_min_m.array()).all() &&
         (position_m.array() <= parameters_.workspace_max_m.array()).all() &&
         position_m.z() >= parameters_.lift_min_m && position_m.z() <= parameters_.lift_max_m;
}

bool FeasibleSpace::is_refused(const Eigen::Vector3d& position_m) const {
  for (const Eigen::Vector3d& refused_m : refused_m_) {
    const double berth_m = std::min(parameters_.clearance_m, 0.5 * (refused_m - present_m_).norm());
    if (distance_to_segment(refused_m, present_m_, position_m) <= berth_m) return true;
  }
  return false;
}

bool FeasibleSpace::path_clear(const Eigen::Vector3d& position_m) {
  SegmentWalk walk(map_.grid(), present_m_, position_m);
  // Most positions that cannot be reached lie in what is unknown themselves.
  if (!walk.at_end() && map_.label(walk.last()) != Label::Empty) return false;
  const int at_present = at_present_.nearest_occupied;
  bool got_clear = at_present == clear_;
  VoxelIndex last = present_;
  bool last_is_clear = is_clear(at_present_);
  while (!walk.at_end()) {
    walk.step();
    const VoxelIndex& voxel = walk.voxel();
    if (map_.label(voxel) != Label::Empty) return false;
    const Surroundings near = surroundings(voxel, last_is_clear ? &last : nullptr);
    if (near.unknown_near) return false;
    if (near.nearest_occupied < (got_clear ? clear_ : at_present)) return false;
    got_clear = got_clear || near.nearest_occupied == clear_;
    last = voxel;
    last_is_clear = is_clear(near);
  }
  return true;
}

FeasibleSpace::Surroundings FeasibleSpace::surroundings(const VoxelIndex& voxel,
                                                        const VoxelIndex* clear_neighbour) {
  const int free_distance = field_ != nullptr ? field_->free_distance(voxel) : 0;
  if (free_distance > reach_) return {clear_, false};
  const auto [entry, inserted] = known_.try_emplace(map_.slot(voxel));
  Surroundings& result = entry->second;
  if (!inserted) return result;
  if (clear_neighbour != nullptr) {
    const VoxelIndex step = voxel - *clear_neighbour;
    int axis = 0;
    step.cwiseAbs().maxCoeff(&axis);
    result = look_around(voxel, entered_by(axis, step[axis]), free_distance);
    if (is_clear(result)) return result;
  }
  result = look_around(voxel, offsets_, free_distance);
  return result;
}

FeasibleSpace::Surroundings FeasibleSpace::look_around(const VoxelIndex& voxel,
                                                       const std::vector<Offset>& offsets,
                                                       int free_distance) const {
  Surroundings result{clear_, false};
  const VoxelIndex corner = VoxelIndex::Constant(reach_);
  const bool all_inside = map_.contains(voxel - corner) && map_.contains(voxel + corner);
  const auto labels = map_.labels();
  // Everything in the shells nearer than the free distance is Empty.
  const auto first = std::ranges::lower_bound(offsets, free_distance, {}, &Offset::shell);
  for (auto offset = first; offset != offsets.end(); ++offset) {
    const auto& [step, squared_length, shell] = *offset;
    const int matters = std::max(body_, result.nearest_occupied);  // what is nearer than that
    if (shell * shell >= matters) break;
    if (squared_length >= matters) continue;
    const VoxelIndex neighbour = voxel + step;
    const Label label = all_inside ? labels[map_.slot(neighbour)] : map_.label(neighbour);
    if (label == Label::Empty) continue;
    if (label == Label::Occupied) {
      result.nearest_occupied = std::min(result.nearest_occupied, squared_length);
    } else if (squared_length < body_ && (neighbour - present_).squaredNorm() >= departure_) {
      result.unknown_near = true;
      // No path leads through here, so nothing else matters; but one begins at the present voxel.
      if (voxel != present_) break;
    }
  }
  return result;
}

}  // namespace nextview
