#pragma once

#include <array>
#include <cstdint>

#include "mapper/voxel_map.h"

namespace nextview {

class MapCounts;
class QualityCensus;

/// How the pixels of a range image that was folded divide, and what they made Occupied.
struct FoldCounts {
  std::int64_t points = 0;          ///< points inside the window
  std::int64_t points_outside = 0;  ///< points outside the window
  std::int64_t no_returns = 0;      ///< known free up to the sensor's largest range (RangeKind)
  std::int64_t invalid = 0;         ///< nothing known
  std::int64_t newly_occupied = 0;  ///< voxels that became Occupied
};

/// What a commit says about a map.
struct MapStatistics {
  std::array<std::int64_t, kLabelCount> voxels = {};  ///< by Label; they sum to the window's volume
  std::int64_t occupied_faces = 0;         ///< faces of Occupied voxels that touch an Empty voxel
  std::int64_t occlusion_plane_faces = 0;  ///< the same of OcclusionPlane voxels
  double occupied_area_m2 = 0.0;           ///< P13: faces times a face's area
  double occlusion_plane_area_m2 = 0.0;
  /// Over the Occupied voxels, in [0, 1]; a voxel none of whose points had a normal counts as 0.
  /// Both are 0 when no voxel is Occupied.
  double mean_quality = 0.0;
  double min_quality = 0.0;
};

MapStatistics map_statistics(const MapCounts& counts, const QualityCensus& quality,
                             double voxel_size_m);

}  // namespace nextview
