#include "scoring/cover_sets.h"

#include <numeric>

namespace nextview {

void CoverSets::add_pose(std::span<const std::uint32_t> covered) {
  if (poses_ % kPosesAPart == 0) parts_.emplace_back();
  Part& part = parts_.back();
  std::uint32_t last = 0;
  for (const std::uint32_t voxel : covered) {
    std::uint32_t step = voxel - last;
    for (; step >= 0x80U; step >>= 7) {
      part.bytes.push_back(static_cast<std::uint8_t>(step | 0x80U));
    }
    part.bytes.push_back(static_cast<std::uint8_t>(step));
    last = voxel;
  }
  part.begin.push_back(static_cast<std::uint32_t>(part.bytes.size()));
  ++poses_;
  if (poses_ % kPosesAPart == 0) part.bytes.shrink_to_fit();
}

std::vector<std::uint32_t> CoverSets::covered_by(std::size_t pose) const {
  std::vector<std::uint32_t> covered;
  for_each_covered(pose, [&](std::uint32_t voxel) { covered.push_back(voxel); });
  return covered;
}

std::int64_t CoverSets::total_weight() const {
  return std::accumulate(weights.begin(), weights.end(), std::int64_t{0});
}

std::size_t CoverSets::bytes() const {
  std::size_t bytes = 0;
  for (const Part& part : parts_) bytes += part.bytes.size();
  return bytes;
}

}  // namespace nextview
