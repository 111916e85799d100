#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <cstdlib>

#include "mapper/voxel_map.h"

namespace nextview {

/// The quality of a predicted view of a voxel (P9, P17) in integers, so that every way of computing
/// it gives the same. The voxel's mean normal and the ray's direction are rounded to multiples of
/// 1/SurfaceVoxel::kNormalUnit; |normal . ray| is then an integer of 1/2^28, of which the largest
/// over a view's rays is taken, and that is rounded to 1/SurfaceVoxel::kQualityUnit.
using QuantisedDirection = std::array<std::int16_t, 3>;
/// Rounds a vector of length <= 1; halves go away from zero.
QuantisedDirection quantise_direction(const Eigen::Vector3d& direction);
/// |normal . ray|, 1/2^28; below 2^29 for rounded unit vectors, and no intermediate sum is larger.
inline std::int32_t quantised_cosine(const QuantisedDirection& normal,
                                     const QuantisedDirection& ray) {
  return std::abs(normal[0] * ray[0] + normal[1] * ray[1] + normal[2] * ray[2]);
}
/// min(kQualityUnit, round(cosine * kQualityUnit / 2^28)).
std::uint16_t predicted_quality(std::int32_t cosine);

}  // namespace nextview
