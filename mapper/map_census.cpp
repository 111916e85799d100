#include "mapper/map_census.h"

#include <algorithm>
#include <cstring>
#include <iterator>

namespace nextview {

namespace {

constexpr std::size_t kSide = MapBlocks::kSide;
constexpr std::uint8_t kListed = 1 << 6;  // above the six bits for sides
constexpr std::uint32_t kNumberMask = (std::uint32_t{1} << MapBlocks::kNumberBits) - 1;

constexpr std::size_t kRow = 16;  // a vector register of bytes

// The labels of a block and of one voxel around it, as bytes: row (y, z) holds the voxels
// x = -1 ... 8 at [0] ... [9].
class Neighbourhood {
 public:
  Neighbourhood(std::span<const Label> labels, const std::array<MapBlocks::AxisSlots, 3>& slots) {
    const auto& [xs, ys, zs] = slots;
    const bool whole_row = xs[kSide] - xs[1] == kSide - 1 && xs[1] != MapBlocks::kOutside;
    for (std::size_t z = 0; z < kSide + 2; ++z) {
      for (std::size_t y = 0; y < kSide + 2; ++y) {
        std::uint8_t* to = bytes_ + kMargin + (z * (kSide + 2) + y) * kRow;
        if (ys[y] == MapBlocks::kOutside || zs[z] == MapBlocks::kOutside) continue;
        const Label* from = labels.data() + ys[y] + zs[z];
        if (whole_row) {
          std::memcpy(to + 1, from + xs[1], kSide);
        } else {
          for (std::size_t x = 1; x <= kSide; ++x) put(from, xs[x], to + x);
        }
        put(from, xs[0], to);
        put(from, xs[kSide + 1], to + kSide + 1);
      }
    }
  }

  // Row (y, z) of the block itself; y, z in 0 ... 7. Index 1 is its first voxel.
  const std::uint8_t* row(std::size_t y, std::size_t z) const {
    return bytes_ + kMargin + ((z + 1) * (kSide + 2) + y + 1) * kRow;
  }
  static constexpr std::ptrdiff_t kNextY = kRow;
  static constexpr std::ptrdiff_t kNextZ = kRow * (kSide + 2);

 private:
  static void put(const Label* from, std::size_t x, std::uint8_t* to) {
    if (x != MapBlocks::kOutside) *to = static_cast<std::uint8_t>(from[x]);
  }

  // Rows are read one voxel before and after their length.
  static constexpr std::size_t kMargin = kRow;
  std::uint8_t bytes_[(kSide + 2) * (kSide + 2) * kRow + 2 * kMargin] = {};
};

constexpr std::uint8_t byte(Label label) { return static_cast<std::uint8_t>(label); }

// The kinds of things counted: voxels by label, then the faces of two labels that touch Empty.
constexpr std::size_t kOccupiedFaces = kLabelCount;
constexpr std::size_t kOcclusionPlaneFaces = kLabelCount + 1;
constexpr std::size_t kKinds = kLabelCount + 2;

// A row of labels or counts as the vector registers of all x86-64 and ARM machines hold it (GCC's
// and clang's vector extension). A comparison gives 255 or 0 in every lane.
using Lanes [[gnu::vector_size(kRow)]] = std::uint8_t;

Lanes load(const std::uint8_t* row) {
  Lanes lanes;
  std::memcpy(&lanes, row, kRow);
  return lanes;
}

Lanes equals(Lanes lanes, Label label) { return reinterpret_cast<Lanes>(lanes == byte(label)); }

// Derives the occlusion planes of a block and counts it. The labels as they become are written to
// now, rows as in the neighbourhood; counts are by kind, Unmarked ones left out.
//
// Lane x of a row is voxel x - 1; lanes 0 and 9 ... 15 are computed for nothing. A lane counts at
// most 6 faces in each of 8 rows before its byte is emptied into a wider number.
void look_at_block(const Neighbourhood& neighbourhood, std::uint8_t (&now)[kSide * kSide][kRow],
                   std::uint16_t (&counts)[kKinds]) {
  std::fill(std::begin(counts), std::end(counts), std::uint16_t{0});
  for (std::size_t z = 0; z < kSide; ++z) {
    Lanes tally[kKinds] = {};
    for (std::size_t y = 0; y < kSide; ++y) {
      const std::uint8_t* const here = neighbourhood.row(y, z);
      Lanes faces = {};  // that touch an Empty voxel
      for (const std::ptrdiff_t next :
           {std::ptrdiff_t{1}, Neighbourhood::kNextY, Neighbourhood::kNextZ}) {
        faces -= equals(load(here - next), Label::Empty) + equals(load(here + next), Label::Empty);
      }
      const Lanes was = load(here);
      const Lanes hidden = equals(was, Label::Occluded) | equals(was, Label::OcclusionPlane) |
                           equals(was, kFreshlyOccluded);
      const Lanes open = reinterpret_cast<Lanes>(faces != 0);
      const Lanes derived = (open & byte(Label::OcclusionPlane)) | (~open & byte(Label::Occluded));
      const Lanes is = (hidden & derived) | (~hidden & was);
      std::memcpy(now[z * kSide + y], &is, kRow);
      for (std::uint8_t label = 1; label < kLabelCount; ++label) {
        tally[label] -= equals(is, static_cast<Label>(label));
      }
      tally[kOccupiedFaces] += faces & equals(is, Label::Occupied);
      tally[kOcclusionPlaneFaces] += faces & hidden;
    }
    for (std::size_t kind = 1; kind < kKinds; ++kind) {
      for (std::size_t x = 1; x <= kSide; ++x) {
        counts[kind] = static_cast<std::uint16_t>(counts[kind] + tally[kind][x]);
      }
    }
  }
}

}  // namespace

MapCensus::MapCensus(const VoxelMap& map, const MapBlocks& blocks)
    : counts_(blocks.size()), touched_(blocks.size(), 0) {
  const VoxelIndex size = map.window().size;
  voxels_[byte(Label::Unmarked)] = std::int64_t{size[0]} * size[1] * size[2];
}

void MapCensus::note_changes(const MapBlocks& blocks, std::span<const std::uint32_t> slots) {
  for (const std::uint32_t slot : slots) {
    const std::uint32_t place = blocks.place(slot);
    const std::uint32_t block = place & kNumberMask;
    if (!touched_[block]) to_look_.push_back(block);
    touched_[block] |= static_cast<std::uint8_t>(kListed | place >> MapBlocks::kNumberBits);
  }
}

void MapCensus::look_at_neighbours(const MapBlocks& blocks) {
  const std::size_t changed = to_look_.size();
  for (std::size_t n = 0; n < changed; ++n) {
    const std::uint32_t block = to_look_[n];
    for (int side = 0; side < 6; ++side) {
      if (!(touched_[block] >> side & 1)) continue;
      VoxelIndex coordinate = blocks.coordinate(block);
      coordinate[side / 2] += side % 2 == 0 ? -1 : 1;
      const std::uint32_t neighbour = blocks.number(coordinate);
      if (neighbour == blocks.size() || touched_[neighbour]) continue;
      touched_[neighbour] = kListed;
      to_look_.push_back(neighbour);
    }
  }
}

std::span<const std::uint32_t> MapCensus::update(VoxelMap& map, const MapBlocks& blocks,
                                                 std::vector<std::uint32_t>& changed_slots) {
  look_at_neighbours(blocks);
  // Blocks next to each other along x share cache lines.
  std::sort(to_look_.begin(), to_look_.end());
  for (const std::uint32_t block : to_look_) {
    add(counts_[block], -1);
    counts_[block] = recount(map, blocks, block, changed_slots);
    add(counts_[block], 1);
    touched_[block] = 0;
  }
  looked_.swap(to_look_);
  to_look_.clear();
  return looked_;
}

MapCensus::Counts MapCensus::recount(VoxelMap& map, const MapBlocks& blocks, std::uint32_t block,
                                     std::vector<std::uint32_t>& changed_slots) {
  const auto slots = blocks.slots_around(block);
  const std::span<Label> labels = map.labels();
  const Neighbourhood neighbourhood(labels, slots);
  std::uint8_t now[kSide * kSide][kRow];
  std::uint16_t counted[kKinds];
  look_at_block(neighbourhood, now, counted);

  for (std::size_t row = 0; row < kSide * kSide; ++row) {
    const std::size_t y = row % kSide;
    const std::size_t z = row / kSide;
    const std::uint8_t* const was = neighbourhood.row(y, z);
    if (std::memcmp(now[row] + 1, was + 1, kSide) == 0) continue;
    for (std::size_t x = 1; x <= kSide; ++x) {
      if (now[row][x] == was[x]) continue;
      const std::size_t slot = slots[0][x] + slots[1][y + 1] + slots[2][z + 1];
      labels[slot] = static_cast<Label>(now[row][x]);
      if (was[x] != byte(kFreshlyOccluded)) {
        changed_slots.push_back(static_cast<std::uint32_t>(slot));
      }
    }
  }

  Counts counts;
  for (std::size_t label = 1; label < kLabelCount; ++label) counts.voxels[label] = counted[label];
  counts.occupied_faces = counted[kOccupiedFaces];
  counts.occlusion_plane_faces = counted[kOcclusionPlaneFaces];
  return counts;
}

void MapCensus::add(const Counts& counts, int sign) {
  for (std::size_t label = 1; label < kLabelCount; ++label) {
    voxels_[label] += sign * counts.voxels[label];
    voxels_[byte(Label::Unmarked)] -= sign * counts.voxels[label];
  }
  occupied_faces_ += sign * counts.occupied_faces;
  occlusion_plane_faces_ += sign * counts.occlusion_plane_faces;
}

std::size_t MapCensus::memory_bytes() const {
  return counts_.capacity() * sizeof(Counts) + touched_.capacity() +
         (to_look_.capacity() + looked_.capacity()) * sizeof(std::uint32_t);
}

}  // namespace nextview
