#include "mapper/packed_block.h"

namespace nextview {

namespace {

constexpr int kWords = static_cast<int>(BlockBits().size());
constexpr std::uint64_t kAllOnes = ~std::uint64_t{0};
constexpr std::uint64_t kOnes = 1;
constexpr std::uint64_t kKept = 2;

}  // namespace

PackedBlock::PackedBlock(const BlockLabels& labels) {
  std::vector<std::uint64_t> words;
  int place = 0;
  for (const BlockBits* set :
       {&labels.empty, &labels.occupied, &labels.hidden, &labels.occlusion_plane}) {
    for (const std::uint64_t word : *set) {
      const std::uint64_t code = word == 0 ? 0 : word == kAllOnes ? kOnes : kKept;
      if (code == kKept) words.push_back(word);
      codes_ |= code << place;
      place += 2;
    }
  }
  words_ = std::vector<std::uint64_t>(words.begin(), words.end());  // no larger than it has to be
}

BlockBits PackedBlock::unpack(int set, std::size_t& next) const {
  BlockBits bits;
  for (int word = 0; word < kWords; ++word) {
    const std::uint64_t code = codes_ >> 2 * (kWords * set + word) & 3;
    bits[static_cast<std::size_t>(word)] = code == kKept ? words_[next++] : kAllOnes * code;
  }
  return bits;
}

BlockLabels PackedBlock::labels() const {
  std::size_t next = 0;
  BlockLabels labels;
  labels.empty = unpack(0, next);
  labels.occupied = unpack(1, next);
  labels.hidden = unpack(2, next);
  labels.occlusion_plane = unpack(3, next);
  return labels;
}

}  // namespace nextview
