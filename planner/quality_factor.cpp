#include "planner/quality_factor.h"

#include "mapper/voxel_map.h"

namespace nextview {

double quality_factor(const ViewCounts& counts) {
  if (counts.improved_voxels == 0) return 0.0;
  const auto improved = static_cast<double>(counts.improved_voxels);
  const double share_improved = improved / static_cast<double>(counts.occupied_voxels);
  const double mean_improvement =
      static_cast<double>(counts.improvement) / improved / SurfaceVoxel::kQualityUnit;
  return share_improved * mean_improvement;
}

}  // namespace nextview
