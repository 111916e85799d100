#pragma once

#include <vector>

#include "mapper/block_hash.h"
#include "mapper/voxel_map.h"

namespace nextview {

/// All there is in a block of a map, wherever the map keeps it.
struct BlockContent {
  LabelBytes labels = kAllUnmarked;
  /// Of the Occupied voxels, in the order of their labels; as made where a voxel has none.
  std::vector<SurfaceVoxel> surfaces;
};

}  // namespace nextview
