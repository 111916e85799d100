#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapper/voxel_map.h"

namespace nextview {

/// How many voxels have which quality: the mean and the smallest without looking at the map.
class QualityCensus {
 public:
  QualityCensus() : voxels_(SurfaceVoxel::kQualityUnit + 1, 0) {}

  /// A voxel's quality goes from one value to a larger one.
  void change(std::uint16_t from, std::uint16_t to) {
    // Voxels of quality 0 are not counted: they are whatever Occupied voxels remain.
    if (from > 0) {
      --voxels_[from];
    } else {
      ++rated_;
    }
    ++voxels_[to];
    sum_ += to - from;
  }

  /// A voxel of this quality is no longer part of the map.
  void forget(std::uint16_t quality) {
    if (quality == 0) return;
    --voxels_[quality];
    --rated_;
    sum_ -= quality;
  }

  /// Mean over this many Occupied voxels, in [0, 1]; 0 when there are none.
  double mean(std::int64_t occupied) const {
    if (occupied == 0) return 0.0;
    return static_cast<double>(sum_) / static_cast<double>(occupied * SurfaceVoxel::kQualityUnit);
  }

  /// The smallest among this many Occupied voxels, in [0, 1]; 0 when there are none.
  double min(std::int64_t occupied) const {
    if (occupied == 0 || rated_ < occupied) return 0.0;
    std::size_t quality = 1;
    while (voxels_[quality] == 0) ++quality;
    return static_cast<double>(quality) / SurfaceVoxel::kQualityUnit;
  }

  std::size_t memory_bytes() const { return voxels_.capacity() * sizeof(std::uint32_t); }

 private:
  std::vector<std::uint32_t> voxels_;  ///< by quality, from 1 on
  std::int64_t rated_ = 0;             ///< sum of voxels_
  std::int64_t sum_ = 0;               ///< of all qualities
};

}  // namespace nextview
