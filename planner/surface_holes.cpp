#include "planner/surface_holes.h"

#include <optional>
#include <stdexcept>
#include <unordered_map>

namespace nextview {

namespace {

bool is_unknown(Label label) { return label != Label::Empty && label != Label::Occupied; }

// Nothing when no Empty voxel shares a face with it.
std::optional<Eigen::Vector3d> outward_of(const VoxelMap& map, const VoxelIndex& voxel) {
  VoxelIndex sum = VoxelIndex::Zero();
  bool touches_empty = false;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int sign : {-1, 1}) {
      VoxelIndex neighbour = voxel;
      neighbour[axis] += sign;
      if (map.label(neighbour) != Label::Empty) continue;
      touches_empty = true;
      sum[axis] += sign;
    }
  }
  if (!touches_empty) return std::nullopt;
  const Eigen::Vector3d outward = sum.cast<double>();
  return sum.isZero() ? outward : Eigen::Vector3d(outward.normalized());
}

std::vector<HoleVoxel> rim_of(const VoxelMap& map) {
  std::vector<HoleVoxel> rim;
  for_each_voxel(map.window(), [&](const VoxelIndex& voxel) {
    if (!is_unknown(map.labels()[map.slot(voxel)])) return;
    if (const auto outward = outward_of(map, voxel)) rim.push_back({voxel, *outward});
  });
  return rim;
}

// The voxels of the rim, each to be taken once.
class Untaken {
 public:
  Untaken(const VoxelMap& map, const std::vector<HoleVoxel>& rim) : map_(map) {
    for (const HoleVoxel& voxel : rim) left_[map.slot(voxel.voxel)] = &voxel;
  }

  const HoleVoxel* take(const VoxelIndex& voxel) {
    if (!map_.contains(voxel)) return nullptr;
    const auto found = left_.find(map_.slot(voxel));
    if (found == left_.end()) return nullptr;
    const HoleVoxel* taken = found->second;
    left_.erase(found);
    return taken;
  }

 private:
  const VoxelMap& map_;
  std::unordered_map<std::size_t, const HoleVoxel*> left_;  // by slot
};

SurfaceHole hole_around(const HoleVoxel& first, int largest_voxels, Untaken& untaken) {
  SurfaceHole hole{{first}};
  for (std::size_t next = 0; next < hole.voxels.size(); ++next) {
    const VoxelIndex around = hole.voxels[next].voxel;
    for_each_voxel({around - VoxelIndex::Ones(), VoxelIndex(3, 3, 3)}, [&](const VoxelIndex& at) {
      if ((at - first.voxel).cwiseAbs().maxCoeff() > largest_voxels) return;
      if (const HoleVoxel* voxel = untaken.take(at)) hole.voxels.push_back(*voxel);
    });
  }
  return hole;
}

}  // namespace

std::vector<SurfaceHole> surface_holes(const VoxelMap& map, int largest_voxels) {
  if (largest_voxels < 1) throw std::invalid_argument("largest_voxels must be positive");
  const std::vector<HoleVoxel> rim = rim_of(map);
  Untaken untaken(map, rim);
  std::vector<SurfaceHole> holes;
  for (const HoleVoxel& voxel : rim) {
    if (untaken.take(voxel.voxel) != nullptr) {
      holes.push_back(hole_around(voxel, largest_voxels, untaken));
    }
  }
  return holes;
}

}  // namespace nextview
