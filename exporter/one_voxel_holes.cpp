#include "exporter/one_voxel_holes.h"

namespace nextview {
namespace {

bool is_gap(const VoxelMap& map, const VoxelIndex& voxel) {
  const Label label = map.label(voxel);
  if (label == Label::Occupied) return false;
  int closed = 0;
  bool open = label == Label::Empty;
  for (int axis = 0; axis < 3; ++axis) {
    const VoxelIndex step = VoxelIndex::Unit(axis);
    const Label below = map.label(voxel - step);
    const Label above = map.label(voxel + step);
    closed += below == Label::Occupied && above == Label::Occupied ? 1 : 0;
    open = open || below == Label::Empty || above == Label::Empty;
  }
  return closed >= 2 && open;
}

}  // namespace

bool is_one_voxel_hole(const VoxelMap& map, const VoxelIndex& voxel) {
  if (!is_gap(map, voxel)) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const VoxelIndex step = VoxelIndex::Unit(axis);
    if (is_gap(map, voxel - step) || is_gap(map, voxel + step)) return false;
  }
  return true;
}

std::vector<VoxelIndex> one_voxel_holes(const VoxelMap& map) {
  std::vector<VoxelIndex> holes;
  for_each_voxel(map.window(), [&](const VoxelIndex& voxel) {
    if (is_one_voxel_hole(map, voxel)) holes.push_back(voxel);
  });
  return holes;
}

}  // namespace nextview
