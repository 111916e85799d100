#pragma once

#include "mapper/voxel_grid.h"
#include "sensor/range_image.h"

namespace nextview {

/// Refuses a range image that cannot be right, or that was taken from outside a map's window.
/// @throws std::invalid_argument saying what is wrong; see MapBuilder::fold
void check_range_image(const RangeImage& image, const VoxelGrid& grid, const MapWindow& window);

}  // namespace nextview
