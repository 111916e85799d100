#pragma once

#include <filesystem>
#include <span>

#include "mapper/voxel_map.h"

namespace nextview {

/// Writes a map as an OctoMap binary tree (.bt): Occupied voxels are occupied, Empty ones free, all
/// others unknown. OctoMap's cells lie between the multiples of their size and ours around them, so
/// the cells are half as long as a voxel, eight of them in each, and voxel and cells cover the same
/// space exactly when the map's origin is a multiple of half a voxel; else the tree is shifted by a
/// quarter of a voxel along each axis at most.
/// @param filled voxels that are occupied in the tree whatever they are in the map: the tree cannot
///        tell them from what was sensed
/// @throws std::runtime_error naming the file when it cannot be written, when the map lies farther
///         from the world's origin than a tree reaches (32 768 cells), or when this program was
///         built without OctoMap
void write_octree(const VoxelMap& map, std::span<const VoxelIndex> filled,
                  const std::filesystem::path& file);

}  // namespace nextview
