#pragma once

#include <cstdint>
#include <vector>

#include "mapper/block_bits.h"

namespace nextview {

/// The labels of a block of 8 x 8 x 8 voxels in little room. They are four sets of eight words; of
/// a word that is all 0 or all 1 two bits say so, and only the others are kept as they are. A block
/// of one label keeps no word at all.
class PackedBlock {
 public:
  PackedBlock() = default;  ///< all Unmarked
  explicit PackedBlock(const BlockLabels& labels);

  /// What has been packed, bit for bit.
  BlockLabels labels() const;
  std::size_t memory_bytes() const { return words_.capacity() * sizeof(std::uint64_t); }

 private:
  BlockBits unpack(int set, std::size_t& next) const;

  std::uint64_t codes_ = 0;  ///< two bits a word: 0 all 0, 1 all 1, 2 kept
  std::vector<std::uint64_t> words_;
};

}  // namespace nextview
