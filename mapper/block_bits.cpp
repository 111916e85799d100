#include "mapper/block_bits.h"

#include <bit>

#include "mapper/voxel_map.h"
#include "sensor/vector_clones.h"

namespace nextview {

namespace {

constexpr std::size_t kSide = kBlockSide;
static_assert(kSide == 8, "a layer is a word, and a row of labels too");
constexpr std::uint64_t kFirstY = 0x0101010101010101u;  // the bits of y = 0
constexpr std::uint64_t kLastY = kFirstY << (kSide - 1);

// The labels' own three bits tell them apart.
static_assert(static_cast<int>(Label::Unmarked) == 0b000);
static_assert(static_cast<int>(Label::Occluded) == 0b001);
static_assert(static_cast<int>(Label::OcclusionPlane) == 0b010);
static_assert(static_cast<int>(Label::Empty) == 0b011);
static_assert(static_cast<int>(Label::Occupied) == 0b100);

}  // namespace

NEXTVIEW_VECTOR_CLONES
void sort_by_label(const BlockRows& rows, BlockLabels& labels) {
#pragma omp simd
  for (std::size_t z = 0; z < kSide; ++z) {
    std::uint64_t bit0 = 0;
    std::uint64_t bit1 = 0;
    std::uint64_t bit2 = 0;
    for (std::size_t y = 0; y < kSide; ++y) {
      const std::uint64_t row = rows[kSide * y + z];
      bit0 |= (row & kFirstY) << y;
      bit1 |= (row >> 1 & kFirstY) << y;
      bit2 |= (row >> 2 & kFirstY) << y;
    }
    labels.empty[z] = bit0 & bit1;
    labels.occupied[z] = bit2;
    labels.hidden[z] = bit0 ^ bit1;
    labels.occlusion_plane[z] = bit1 & ~bit0;
  }
}

NEXTVIEW_VECTOR_CLONES
void find_empty_neighbours(const BlockLabels& labels, const std::array<const BlockBits*, 6>& beyond,
                           EmptyNeighbours& neighbours) {
  std::uint64_t layers[kSide + 2];  // with the one before and the one after
  layers[0] = (*beyond[4])[kSide - 1];
  for (std::size_t z = 0; z < kSide; ++z) layers[z + 1] = labels.empty[z];
  layers[kSide + 1] = (*beyond[5])[0];

  int occupied_faces = 0;
  int hidden_faces = 0;
  for (std::size_t z = 0; z < kSide; ++z) {
    const std::uint64_t here = labels.empty[z];
    const std::uint64_t at_face[] = {
        here << kSide | (*beyond[0])[z] >> (64 - kSide),
        here >> kSide | (*beyond[1])[z] << (64 - kSide),
        (here << 1 & ~kFirstY) | ((*beyond[2])[z] >> (kSide - 1) & kFirstY),
        (here >> 1 & ~kLastY) | ((*beyond[3])[z] << (kSide - 1) & kLastY),
        layers[z],
        layers[z + 2]};
    std::uint64_t any = 0;
    for (const std::uint64_t empty : at_face) {
      any |= empty;
      occupied_faces += std::popcount(empty & labels.occupied[z]);
      hidden_faces += std::popcount(empty & labels.hidden[z]);
    }
    neighbours.any[z] = any;
  }
  neighbours.occupied_faces = occupied_faces;
  neighbours.hidden_faces = hidden_faces;
}

NEXTVIEW_VECTOR_CLONES
int count(const BlockBits& bits) {
  int sum = 0;
  for (const std::uint64_t word : bits) sum += std::popcount(word);
  return sum;
}

unsigned sides_touched(const BlockBits& bits) {
  std::uint64_t all = 0;
  for (const std::uint64_t word : bits) all |= word;
  const bool touched[] = {(all & 0xff) != 0,   all >> 56 != 0, (all & kFirstY) != 0,
                          (all & kLastY) != 0, bits[0] != 0,   bits[kSide - 1] != 0};
  unsigned sides = 0;
  for (unsigned side = 0; side < 6; ++side) sides |= static_cast<unsigned>(touched[side]) << side;
  return sides;
}

}  // namespace nextview
