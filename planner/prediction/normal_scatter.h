#pragma once

#include <cstdint>

#include "planner/prediction/predicted_quality.h"

namespace nextview {

/// How normals are spread (P18): the sum of n n^T over them, of a symmetric matrix the six elements
/// that differ. In integers of 1/SurfaceVoxel::kNormalUnit^2, so that their order does not matter.
struct NormalScatter {
  std::int64_t xx = 0;
  std::int64_t yy = 0;
  std::int64_t zz = 0;
  std::int64_t xy = 0;
  std::int64_t xz = 0;
  std::int64_t yz = 0;

  /// Of a zero vector, which stands for no normal, nothing is added.
  void add(const QuantisedDirection& normal) {
    const auto [x, y, z] = normal;
    xx += x * x;
    yy += y * y;
    zz += z * z;
    xy += x * y;
    xz += x * z;
    yz += y * z;
  }

  bool operator==(const NormalScatter& other) const = default;
};

}  // namespace nextview
