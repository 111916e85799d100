#include "planner/fitness.h"

#include <cmath>

namespace nextview {

double area_fitness(double a_ov, double a_op, double a_us) {
  return ((5.0 * a_ov - 10.5) * a_ov + 6.0) * a_ov * (1.0 - 0.5 * std::abs(a_op - a_us));
}

Fitness fitness(const ViewCounts& counts, const Travel& travel, const FactorWeights& weights) {
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
    const Factor& factor = kFactors[i];
    result.factors[i] =
        factor.of_surfaces != nullptr ? factor.of_surfaces(counts) : factor.of_travel(travel);
    result.value *= 1.0 + weights[i] * result.factors[i];
  }
  return result;
}

}  // namespace nextview
