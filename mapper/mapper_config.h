#pragma once

#include "lcmtypes/channels.h"
#include "mapper/voxel_grid.h"

namespace nextview {

/// The lattice and the extent of a run's map.
VoxelGrid grid_of(const run_config_t& config);
MapWindow window_of(const run_config_t& config);

/// Whether a range image can belong to a run: its view is one the run may have, and its sensor lies
/// inside the map.
/// @throws RejectedMessage saying what does not fit
void check_fits_run(const range_image_t& image, const run_config_t& config);

}  // namespace nextview
