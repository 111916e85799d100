#include "planner/fitness.h"

#include <cmath>

#include "mapper/voxel_map.h"

namespace nextview {

double area_fitness(double a_ov, double a_op, double a_us) {
  return ((5.0 * a_ov - 10.5) * a_ov + 6.0) * a_ov * (1.0 - 0.5 * std::abs(a_op - a_us));
}

double quality_factor(const ViewCounts& counts) {
  if (counts.improved_voxels == 0) return 0.0;
  const auto improved = static_cast<double>(counts.improved_voxels);
  const double share_improved = improved / static_cast<double>(counts.occupied_voxels);
  const double mean_improvement =
      static_cast<double>(counts.improvement) / improved / SurfaceVoxel::kQualityUnit;
  return share_improved * mean_improvement;
}

Fitness fitness(const ViewCounts& counts, const FactorWeights& weights) {
  Fitness result;
  const std::int64_t met = counts.occupied + counts.occlusion_plane + counts.unseen;
  const std::int64_t rays = met + counts.open;
  if (rays > 0) {
    result.share_open = static_cast<double>(counts.open) / static_cast<double>(rays);
  }
  if (met == 0) return result;
  const auto share = [met](std::int64_t count) {
    return static_cast<double>(count) / static_cast<double>(met);
  };
  result.share_occupied = share(counts.occupied);
  result.share_occlusion_plane = share(counts.occlusion_plane);
  result.share_unseen = share(counts.unseen);
  result.value =
      area_fitness(result.share_occupied, result.share_occlusion_plane, result.share_unseen);
  for (std::size_t i = 0; i < kFactors.size(); ++i) {  // eq. 4
    if (weights[i] == 0.0) continue;
    result.factors[i] = kFactors[i].of(counts);
    result.value *= 1.0 + weights[i] * result.factors[i];
  }
  return result;
}

}  // namespace nextview
