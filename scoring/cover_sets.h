#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nextview {

/// Which voxels each of many poses would cover, and what each voxel is worth.
///
/// Poses of a building cover a thousand million voxels together. Numbered along a curve through the
/// scene, those of one pose are near to each other, so what is kept is how far each is from the one
/// before: little more than a byte a voxel.
class CoverSets {
 public:
  std::vector<std::uint32_t> weights;  ///< by voxel: samples in it

  std::size_t poses() const { return poses_; }
  /// @param covered each voxel once, ascending
  void add_pose(std::span<const std::uint32_t> covered);

  /// Calls visit(voxel) for what a pose covers, ascending.
  template <class Visit>
  void for_each_covered(std::size_t pose, const Visit& visit) const {
    const Part& part = parts_[pose / kPosesAPart];
    const std::size_t in_part = pose % kPosesAPart;
    const std::uint8_t* at = part.bytes.data() + part.begin[in_part];
    const std::uint8_t* const end = part.bytes.data() + part.begin[in_part + 1];
    std::uint32_t voxel = 0;
    while (at != end) {
      std::uint32_t step = *at & 0x7fU;
      for (int shift = 7; (*at++ & 0x80U) != 0; shift += 7) {
        step |= (*at & 0x7fU) << shift;
      }
      voxel += step;
      visit(voxel);
    }
  }
  std::vector<std::uint32_t> covered_by(std::size_t pose) const;

  std::int64_t total_weight() const;
  std::size_t bytes() const;

 private:
  /// So many that what has to be moved when one grows is little.
  static constexpr std::size_t kPosesAPart = 8192;
  struct Part {
    std::vector<std::uint8_t> bytes;         ///< seven bits each, the eighth set when more follow
    std::vector<std::uint32_t> begin = {0};  ///< into bytes; one more than there are poses
  };

  std::vector<Part> parts_;
  std::size_t poses_ = 0;
};

}  // namespace nextview
