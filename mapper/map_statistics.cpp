#include "mapper/map_statistics.h"

#include "mapper/block_counts.h"
#include "mapper/quality_census.h"

namespace nextview {

MapStatistics map_statistics(const MapCounts& counts, const QualityCensus& quality,
                             double voxel_size_m) {
  MapStatistics statistics;
  for (std::size_t label = 0; label < kLabelCount; ++label) {
    statistics.voxels[label] = counts.voxels(static_cast<Label>(label));
  }
  statistics.occupied_faces = counts.occupied_faces();
  statistics.occlusion_plane_faces = counts.occlusion_plane_faces();
  const double face_m2 = voxel_size_m * voxel_size_m;
  statistics.occupied_area_m2 = static_cast<double>(statistics.occupied_faces) * face_m2;
  statistics.occlusion_plane_area_m2 =
      static_cast<double>(statistics.occlusion_plane_faces) * face_m2;
  const std::int64_t occupied = counts.voxels(Label::Occupied);
  statistics.mean_quality = quality.mean(occupied);
  statistics.min_quality = quality.min(occupied);
  return statistics;
}

}  // namespace nextview
