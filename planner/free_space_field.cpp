#include "planner/free_space_field.h"

#include <algorithm>
#include <bit>
#include <stdexcept>

namespace nextview {

namespace {

using Word = std::uint64_t;
constexpr int kWordBits = 64;
constexpr int kCounterBits = 5;  // counts to kMaxJump
static_assert((1 << kCounterBits) - 1 == FreeSpaceField::kMaxJump);

// Eight bits as eight bytes of 0 or 1, the lowest bit in the lowest byte.
constexpr std::array<Word, 256> make_spread_table() {
  std::array<Word, 256> table{};
  for (std::size_t bits = 0; bits < table.size(); ++bits) {
    for (std::size_t i = 0; i < 8; ++i) {
      if ((bits >> i & 1) != 0) table[bits] |= Word{1} << (8 * i);
    }
  }
  return table;
}
constexpr std::array<Word, 256> kSpread = make_spread_table();

// A box of bit rows that is eroded in place, with a counter per bit of how often it survived.
class Erosion {
 public:
  // Rows of `words` words, `rows` rows a layer, `layers` layers.
  Erosion(std::size_t words, std::size_t rows, std::size_t layers)
      : words_(words), rows_(rows), layers_(layers), set_(words * rows * layers), scratch_(set_) {
    for (auto& plane : counter_) plane.assign(set_.size(), 0);
  }

  Word* row(std::size_t y, std::size_t z) { return &set_[(z * rows_ + y) * words_]; }

  // Counts every bit that is set now, then keeps those whose 26 neighbours are set too. What lies
  // beyond the box counts as set. Returns whether any bit was set.
  bool count_and_erode() {
    if (!count()) return false;
    erode_along_rows();
    erode_across(words_, rows_, layers_);
    erode_across(words_ * rows_, layers_, 1);
    return true;
  }

  // Byte i: how often bit i of byte `byte` of a word was counted.
  Word counts(std::size_t word, int byte) const {
    Word result = 0;
    for (std::size_t plane = 0; plane < kCounterBits; ++plane) {
      result |= kSpread[counter_[plane][word] >> (8 * byte) & 255] << plane;
    }
    return result;
  }
  std::size_t word_index(std::size_t word, std::size_t y, std::size_t z) const {
    return (z * rows_ + y) * words_ + word;
  }

 private:
  bool count() {
    Word any = 0;
    for (std::size_t i = 0; i < set_.size(); ++i) {
      Word carry = set_[i];
      any |= carry;
      for (auto& plane : counter_) {
        const Word sum = plane[i] ^ carry;
        carry &= plane[i];
        plane[i] = sum;
      }
    }
    return any != 0;
  }

  void erode_along_rows() {
    for (std::size_t begin = 0; begin < set_.size(); begin += words_) {
      Word* words = &set_[begin];
      Word previous = ~Word{0};
      for (std::size_t i = 0; i < words_; ++i) {
        const Word here = words[i];
        const Word next = i + 1 < words_ ? words[i + 1] : ~Word{0};
        words[i] = here & (here << 1 | previous >> (kWordBits - 1)) &
                   (here >> 1 | next << (kWordBits - 1));
        previous = here;
      }
    }
  }

  // `groups` times `count` runs of `stride` words: each run is and-ed with the runs before and
  // after.
  void erode_across(std::size_t stride, std::size_t count, std::size_t groups) {
    scratch_ = set_;
    for (std::size_t group = 0; group < groups; ++group) {
      for (std::size_t run = 0; run < count; ++run) {
        const std::size_t begin = (group * count + run) * stride;
        Word* out = &set_[begin];
        if (run > 0) {
          const Word* before = &scratch_[begin - stride];
          for (std::size_t i = 0; i < stride; ++i) out[i] &= before[i];
        }
        if (run + 1 < count) {
          const Word* after = &scratch_[begin + stride];
          for (std::size_t i = 0; i < stride; ++i) out[i] &= after[i];
        }
      }
    }
  }

  std::size_t words_;
  std::size_t rows_;
  std::size_t layers_;
  std::vector<Word> set_;
  std::vector<Word> scratch_;
  std::array<std::vector<Word>, kCounterBits> counter_;
};

}  // namespace

std::uint8_t FreeSpaceField::byte_of(Label label) {
  switch (label) {
    case Label::Unmarked:
    case Label::Occluded:
      return kUnseen;
    case Label::OcclusionPlane:
      return kOcclusionPlane;
    case Label::Empty:
      return kJump + 1;
    case Label::Occupied:
      return kOccupied;
  }
  throw std::logic_error("a label that does not exist");
}

FreeSpaceField::FreeSpaceField(const VoxelMap& map)
    : window_(map.window()), cells_(map.window().size + VoxelIndex::Constant(2)) {
  int bits = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    shift_[axis] = bits;
    bits += std::bit_width(static_cast<unsigned>(cells_[static_cast<int>(axis)] - 1));
  }
  if (bits > 30) {
    throw std::invalid_argument("the map's window is too large to plan in: choose larger voxels");
  }
  words_ = static_cast<std::size_t>((cells_[0] + kWordBits - 1) / kWordBits);
  bytes_.assign((static_cast<std::size_t>(cells_[2]) << shift_[2]) + 3, kOutside);
  empty_.assign(words_ * static_cast<std::size_t>(cells_[1]) * static_cast<std::size_t>(cells_[2]),
                0);
  for (int z = 0; z < window_.size[2]; ++z) {
    for (int y = 0; y < window_.size[1]; ++y) {
      for (int x = 0; x < window_.size[0]; ++x) {
        const VoxelIndex index = window_.min + VoxelIndex(x, y, z);
        const Label label = map.label(index);
        bytes_[offset(index)] = byte_of(label);
        set_empty(VoxelIndex(x + 1, y + 1, z + 1), label == Label::Empty);
      }
    }
  }
  find_distances({VoxelIndex::Zero(), cells_});
}

void FreeSpaceField::set_empty(const VoxelIndex& cell, bool empty) {
  Word& word = empty_[word_row(cell[1], cell[2]) + static_cast<std::size_t>(cell[0] / kWordBits)];
  const Word bit = Word{1} << (cell[0] % kWordBits);
  word = empty ? word | bit : word & ~bit;
}

void FreeSpaceField::update(const VoxelMap& map, std::span<const std::uint32_t> changed_slots) {
  if (map.window() != window_) {
    *this = FreeSpaceField(map);
    return;
  }
  Box changed{cells_, VoxelIndex::Zero()};
  const auto labels = map.labels();
  for (const std::uint32_t slot : changed_slots) {
    const VoxelIndex index = map.index_of_slot(slot);
    std::uint8_t& byte = bytes_[offset(index)];
    const Label label = labels[slot];
    const bool was_empty = byte > kJump;
    const bool is_empty = label == Label::Empty;
    byte = byte_of(label);
    if (was_empty != is_empty) {
      const VoxelIndex cell = index - window_.min + VoxelIndex::Ones();
      set_empty(cell, is_empty);
      changed.min = changed.min.cwiseMin(cell);
      changed.end = changed.end.cwiseMax(cell + VoxelIndex::Ones());
    }
  }
  if ((changed.min.array() < changed.end.array()).all()) find_distances(changed);
}

void FreeSpaceField::find_distances(const Box& changed) {
  // A distance depends on cells up to kMaxJump away, so `fresh` is where distances may be different
  // and `seen` what they depend on. Along x whole words are taken.
  const auto clamp = [this](const Box& box, int margin) {
    return Box{(box.min - VoxelIndex::Constant(margin)).cwiseMax(0),
               (box.end + VoxelIndex::Constant(margin)).cwiseMin(cells_)};
  };
  const Box fresh = clamp(changed, kMaxJump - 1);
  const Box seen = clamp(fresh, kMaxJump - 1);
  const auto first_word = static_cast<std::size_t>(seen.min[0] / kWordBits);
  const auto end_word = static_cast<std::size_t>((seen.end[0] + kWordBits - 1) / kWordBits);
  const auto extent = [&seen](int axis) {
    return static_cast<std::size_t>(seen.end[axis] - seen.min[axis]);
  };

  Erosion erosion(end_word - first_word, extent(1), extent(2));
  for (int z = seen.min[2]; z < seen.end[2]; ++z) {
    for (int y = seen.min[1]; y < seen.end[1]; ++y) {
      const Word* from = &empty_[word_row(y, z) + first_word];
      std::copy_n(from, end_word - first_word,
                  erosion.row(static_cast<std::size_t>(y - seen.min[1]),
                              static_cast<std::size_t>(z - seen.min[2])));
    }
  }
  for (int i = 0; i < kMaxJump && erosion.count_and_erode(); ++i) {
  }

  for (int z = fresh.min[2]; z < fresh.end[2]; ++z) {
    for (int y = fresh.min[1]; y < fresh.end[1]; ++y) {
      const std::size_t row =
          (static_cast<std::size_t>(y) << shift_[1]) + (static_cast<std::size_t>(z) << shift_[2]);
      for (int x = fresh.min[0] / 8 * 8; x < fresh.end[0]; x += 8) {
        const auto word = static_cast<std::size_t>(x / kWordBits);
        Word empty = empty_[word_row(y, z) + word] >> (x % kWordBits) & 255;
        // Cells of this byte that are not fresh may have lost what their distance depends on.
        if (x < fresh.min[0]) empty &= Word{255} << (fresh.min[0] - x);
        if (x + 8 > fresh.end[0]) empty &= Word{255} >> (x + 8 - fresh.end[0]);
        if (empty == 0) continue;
        const Word counts = erosion.counts(
            erosion.word_index(word - first_word, static_cast<std::size_t>(y - seen.min[1]),
                               static_cast<std::size_t>(z - seen.min[2])),
            x % kWordBits / 8);
        for (int i = 0; i < 8; ++i) {
          if ((empty >> i & 1) != 0) {
            bytes_[row + static_cast<std::size_t>(x + i)] =
                static_cast<std::uint8_t>(kJump + (counts >> (8 * i) & 255));
          }
        }
      }
    }
  }
}

}  // namespace nextview
