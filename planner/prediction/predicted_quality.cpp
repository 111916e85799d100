#include "planner/prediction/predicted_quality.h"

#include <algorithm>
#include <cmath>

namespace nextview {

QuantisedDirection quantise_direction(const Eigen::Vector3d& direction) {
  QuantisedDirection quantised;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    quantised[axis] = static_cast<std::int16_t>(
        std::lround(direction[static_cast<int>(axis)] * SurfaceVoxel::kNormalUnit));
  }
  return quantised;
}

std::uint16_t predicted_quality(std::int32_t cosine) {
  const std::int64_t rounded =
      (std::int64_t{cosine} * SurfaceVoxel::kQualityUnit + (std::int64_t{1} << 27)) >> 28;
  return static_cast<std::uint16_t>(std::min<std::int64_t>(rounded, SurfaceVoxel::kQualityUnit));
}

}  // namespace nextview
