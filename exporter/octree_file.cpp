#include "exporter/octree_file.h"

#include <octomap/octomap.h>

#include <cmath>
#include <stdexcept>

namespace nextview {
namespace {

constexpr int kCellsOnASide = 32768;  // of the tree, to either side of the origin

// The cell of a voxel with the smallest coordinates, counted from the world's origin.
VoxelIndex first_cell(const VoxelGrid& grid, const VoxelIndex& voxel) {
  const double cell_m = 0.5 * grid.voxel_size_m;
  const Eigen::Vector3d corner_m =
      grid.center_m(voxel) - Eigen::Vector3d::Constant(0.5 * grid.voxel_size_m);
  return (corner_m / cell_m).array().round().cast<int>();
}

}  // namespace

void write_octree(const VoxelMap& map, std::span<const VoxelIndex> filled,
                  const std::filesystem::path& file) {
  octomap::OcTree tree(0.5 * map.grid().voxel_size_m);
  const auto put = [&](const VoxelIndex& voxel, bool occupied) {
    const VoxelIndex first = first_cell(map.grid(), voxel);
    if ((first.array().abs() >= kCellsOnASide - 1).any()) {
      throw std::runtime_error(
          file.string() + ": the map lies too far from the world's origin for an OctoMap tree");
    }
    for_each_voxel({first, VoxelIndex(2, 2, 2)}, [&](const VoxelIndex& cell) {
      const octomap::OcTreeKey key(static_cast<octomap::key_type>(cell.x() + kCellsOnASide),
                                   static_cast<octomap::key_type>(cell.y() + kCellsOnASide),
                                   static_cast<octomap::key_type>(cell.z() + kCellsOnASide));
      tree.updateNode(key, occupied);
    });
  };
  for_each_voxel(map.window(), [&](const VoxelIndex& voxel) {
    const Label label = map.label(voxel);
    if (label == Label::Occupied || label == Label::Empty) put(voxel, label == Label::Occupied);
  });
  for (const VoxelIndex& voxel : filled) put(voxel, true);  // outweighs that it was free
  if (!tree.writeBinary(file.string())) {
    throw std::runtime_error(file.string() + ": cannot be written; does its folder exist?");
  }
}

}  // namespace nextview
