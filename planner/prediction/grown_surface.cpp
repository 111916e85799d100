#include "planner/prediction/grown_surface.h"

#include <algorithm>
#include <cmath>

#include "sensor/elementary_functions.h"

namespace nextview {

namespace {

bool is_unknown(Label label) { return label != Label::Empty && label != Label::Occupied; }

constexpr std::int8_t kMaxEmpty = 2;  // voxels a plane bridges

}  // namespace

GrownSurface::GrownSurface(const VoxelMap& map)
    : reach_(std::max(1, static_cast<int>(kReach_m / map.grid().voxel_size_m))),
      expected_(map.grid(), map.window(), Label::Empty),
      field_(FreeSpaceField::all_empty(map.window())),
      with_unknown_(map.grid(), map.window()),
      unknown_too_(with_unknown_) {
  const double decay = kDecay_m / map.grid().voxel_size_m;
  for (int squared = 0; squared <= reach_ * reach_; ++squared) {
    by_distance_.push_back(static_cast<std::int32_t>(
        std::lround(kCertain * elementary::exp(-std::sqrt(squared) / decay))));
  }
  buckets_.resize(by_distance_.size());
  likelihood_ = LazyArray<std::int32_t>(field_.size());
  std::vector<std::uint32_t> known;
  map.for_each_marked([&](std::size_t slot, Label label) {
    if (!is_unknown(label)) known.push_back(static_cast<std::uint32_t>(slot));
  });
  update(map, known);
}

void GrownSurface::update(const VoxelMap& map, std::span<const std::uint32_t> changed_slots) {
  changed_.clear();
  if (changed_slots.empty()) return;
  const MapWindow& window = map.window();
  VoxelIndex min = window.min + window.size;
  VoxelIndex end = window.min;
  for (const std::uint32_t slot : changed_slots) {
    const VoxelIndex index = map.index_of_slot(slot);
    min = min.cwiseMin(index);
    end = end.cwiseMax(index + VoxelIndex::Ones());
    const Label label = map.labels()[slot] == Label::Occupied ? Label::Occupied : Label::Empty;
    if (expected_.labels()[slot] == Label::OcclusionPlane) continue;  // withdrawn below
    if (expected_.labels()[slot] != label) {
      expected_.labels()[slot] = label;
      changed_.push_back(slot);
    }
  }
  min = (min - VoxelIndex::Constant(reach_)).cwiseMax(window.min);
  end = (end + VoxelIndex::Constant(reach_)).cwiseMin(window.min + window.size);
  const auto begins_near = [&](const Grown& grown) {
    return (grown.from.array() >= min.array()).all() && (grown.from.array() < end.array()).all();
  };
  std::erase_if(grown_, [&](const Grown& grown) {
    if (!begins_near(grown)) return false;
    expected_.labels()[grown.slot] =
        map.labels()[grown.slot] == Label::Occupied ? Label::Occupied : Label::Empty;
    likelihood_[field_.offset(map.index_of_slot(grown.slot))] = 0;
    changed_.push_back(grown.slot);
    return true;
  });
  grow(map, min, end);
  std::ranges::sort(changed_);
  changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
  field_.update(expected_, changed_);
  follow_unknown(map, changed_slots);
}

void GrownSurface::follow_unknown(const VoxelMap& map,
                                  std::span<const std::uint32_t> changed_slots) {
  std::vector<std::uint32_t> different;
  const auto follow = [&](std::uint32_t slot) {
    const Label known = is_unknown(map.labels()[slot]) ? Label::Unmarked : map.labels()[slot];
    const bool grown = expected_.labels()[slot] == Label::OcclusionPlane;
    const Label label = grown ? Label::OcclusionPlane : known;
    if (with_unknown_.labels()[slot] == label) return;
    with_unknown_.labels()[slot] = label;
    different.push_back(slot);
  };
  std::ranges::for_each(changed_slots, follow);
  std::ranges::for_each(changed_, follow);
  bridges_.clear();
  for (const Grown& grown : grown_) {
    if (map.labels()[grown.slot] == Label::Empty) bridges_.push_back(map.index_of_slot(grown.slot));
  }
  unknown_too_.update(with_unknown_, different);
}

void GrownSurface::grow(const VoxelMap& map, const VoxelIndex& min, const VoxelIndex& end) {
  planes_.clear();
  for (int k = min[2]; k < end[2]; ++k) {
    for (int j = min[1]; j < end[1]; ++j) {
      for (int i = min[0]; i < end[0]; ++i) {
        const VoxelIndex voxel(i, j, k);
        if (map.labels()[map.slot(voxel)] == Label::Occupied) add_plane(map, voxel);
      }
    }
  }
  // Nearest first, so that a voxel goes to the plane whose surface is nearest. A bucket may grow
  // while it is emptied.
  for (std::size_t bucket = 0; bucket < buckets_.size(); ++bucket) {
    for (std::size_t i = 0; i < buckets_[bucket].size(); ++i) {
      const Growing at = buckets_[bucket][i];
      const auto slot = static_cast<std::uint32_t>(map.slot(at.voxel));
      if (expected_.labels()[slot] != Label::Empty) continue;  // another came first
      expected_.labels()[slot] = Label::OcclusionPlane;
      const Plane& plane = planes_[at.plane];
      const auto squared = static_cast<std::size_t>((at.voxel - plane.from).squaredNorm());
      likelihood_[field_.offset(at.voxel)] = by_distance_[squared] / (at.empty > 0 ? 2 : 1);
      grown_.push_back({slot, plane.from});
      changed_.push_back(slot);
      step_from(map, at, bucket);
    }
    buckets_[bucket].clear();
  }
}

void GrownSurface::add_plane(const VoxelMap& map, const VoxelIndex& voxel) {
  const SurfaceVoxel* surface = map.surface(voxel);
  if (surface == nullptr) return;
  const Eigen::Vector3f normal = surface->mean_normal().cast<float>();
  if (normal.isZero()) return;
  const auto plane = static_cast<std::uint32_t>(planes_.size());
  planes_.push_back({voxel, normal, 0.5f * normal.cwiseAbs().maxCoeff()});
  step_from(map, {voxel, plane, 0}, 0);
}

bool GrownSurface::in_plane(const Plane& plane, const VoxelIndex& voxel) const {
  const float off = plane.normal.dot((voxel - plane.from).cast<float>());
  return std::abs(off) <= plane.half_thickness;
}

void GrownSurface::step_from(const VoxelMap& map, const Growing& at, std::size_t bucket) {
  const Plane& plane = planes_[at.plane];
  for (int k = -1; k <= 1; ++k) {
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i) {
        const VoxelIndex step(i, j, k);
        const VoxelIndex next = at.voxel + step;
        if (step.isZero() || !map.contains(next)) continue;
        const std::size_t slot = map.slot(next);
        if (expected_.labels()[slot] != Label::Empty || !in_plane(plane, next)) continue;
        std::int8_t empty = 0;
        if (!is_unknown(map.labels()[slot])) {
          empty = static_cast<std::int8_t>(at.empty + 1);
          if (empty > kMaxEmpty) continue;
          const auto unknown = [&](const VoxelIndex& voxel) {
            return map.contains(voxel) && is_unknown(map.labels()[map.slot(voxel)]);
          };
          const bool leads_on = unknown(next + step) ||
                                (empty < kMaxEmpty && map.label(next + step) == Label::Empty &&
                                 unknown(next + 2 * step));
          if (!leads_on) continue;
        }
        const auto squared = static_cast<std::size_t>((next - plane.from).squaredNorm());
        if (squared >= buckets_.size()) continue;
        buckets_[std::max(bucket, squared)].push_back({next, at.plane, empty});
      }
    }
  }
}

std::size_t GrownSurface::memory_bytes() const {
  return expected_.memory_bytes() + field_.memory_bytes() + with_unknown_.memory_bytes() +
         unknown_too_.memory_bytes() + likelihood_.memory_bytes();
}

}  // namespace nextview
