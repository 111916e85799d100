#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nextview {

/// Which voxels each of many poses would cover, and what each voxel is worth.
struct CoverSets {
  std::vector<std::uint32_t> weights;      ///< by voxel: samples in it
  std::vector<std::uint64_t> begin = {0};  ///< into voxels; one more than there are poses
  std::vector<std::uint32_t> voxels;       ///< those of a pose in a row, each once

  std::size_t poses() const { return begin.size() - 1; }
  std::span<const std::uint32_t> covered_by(std::size_t pose) const {
    return {voxels.data() + begin[pose], voxels.data() + begin[pose + 1]};
  }
  void add_pose(std::span<const std::uint32_t> covered) {
    voxels.insert(voxels.end(), covered.begin(), covered.end());
    begin.push_back(voxels.size());
  }
  std::int64_t total_weight() const {
    std::int64_t total = 0;
    for (const std::uint32_t weight : weights) total += weight;
    return total;
  }
};

}  // namespace nextview
