#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mapper/ray_ends.h"
#include "mapper/voxel_map.h"

namespace nextview {

/// Marks the voxels that the rays of one range image pass, hit and hide (P11, P12): along the voxel
/// line from the sensor to each end, and from a surface on along the line to the limit of each of
/// its shadows, for the rays that meet in one voxel part again behind it:
///
///     sensor . . . . . . [end] # # # # #|  limits of the window
///       Empty          Occupied  # # # #|
///                               Occluded
///
/// An end that is no surface is marked Empty like the voxels before it, and nothing beyond it.
/// A mark raises a label to the larger of the two and never lowers it (see Label), so no order of
/// the rays matters. Marks are set strongest first, all hits, then all misses, then all shadows:
/// then no voxel changes twice.
///
/// @param sensor        the voxel of the sensor, inside the map's window
/// @param shadows       of these ends
/// @param changed_slots receives, appended, the slots whose label has changed, each once
/// @return how many voxels became Occupied
std::int64_t mark_rays(VoxelMap& map, const VoxelIndex& sensor, std::span<const RayEnd> ends,
                       std::span<const Shadow> shadows, std::vector<std::uint32_t>& changed_slots);

}  // namespace nextview
