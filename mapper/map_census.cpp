#include "mapper/map_census.h"

#include <cstring>

namespace nextview {

namespace {

constexpr std::size_t kSide = MapBlocks::kSide;
constexpr std::uint8_t kListed = 1 << 6;  // above the six bits for sides
constexpr std::uint32_t kNumberMask = (std::uint32_t{1} << MapBlocks::kNumberBits) - 1;

// The labels of a block and of one voxel around it, as bytes: row (y, z) holds the voxels
// x = -1 ... 8 at [0] ... [9], and its length is that of a vector register.
class Neighbourhood {
 public:
  static constexpr std::size_t kRow = 16;

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
  constexpr std::size_t kRow = Neighbourhood::kRow;
  const auto slots = blocks.slots_around(block);
  const std::span<Label> labels = map.labels();
  const Neighbourhood neighbourhood(labels, slots);

  // Lane x of a row is its voxel x - 1; lanes 0 and 9 ... 15 are computed for nothing. A lane
  // counts at most 6 faces x 8 rows before it is emptied, so bytes hold it.
  std::array<std::array<std::uint16_t, kRow>, kLabelCount + 2> sums = {};
  for (std::size_t z = 0; z < kSide; ++z) {
    std::uint8_t tally[kLabelCount + 2][kRow] = {};
    for (std::size_t y = 0; y < kSide; ++y) {
      const std::uint8_t* const here = neighbourhood.row(y, z);
      std::uint8_t now[kRow];
      for (std::size_t x = 0; x < kRow; ++x) {
        const auto empty = [&](std::ptrdiff_t to) {
          return static_cast<std::uint8_t>(here[static_cast<std::ptrdiff_t>(x) + to] ==
                                           byte(Label::Empty));
        };
        const auto faces = static_cast<std::uint8_t>(
            empty(-1) + empty(1) + empty(-Neighbourhood::kNextY) + empty(Neighbourhood::kNextY) +
            empty(-Neighbourhood::kNextZ) + empty(Neighbourhood::kNextZ));
        const std::uint8_t was = here[x];
        const bool hidden = was == byte(Label::Occluded) || was == byte(Label::OcclusionPlane) ||
                            was == byte(kFreshlyOccluded);
        const std::uint8_t derived =
            faces > 0 ? byte(Label::OcclusionPlane) : byte(Label::Occluded);
        now[x] = hidden ? derived : was;
        for (std::uint8_t label = 1; label < kLabelCount; ++label) {
          tally[label][x] = static_cast<std::uint8_t>(tally[label][x] + (now[x] == label));
        }
        tally[kLabelCount][x] = static_cast<std::uint8_t>(
            tally[kLabelCount][x] + (was == byte(Label::Occupied) ? faces : 0));
        tally[kLabelCount + 1][x] =
            static_cast<std::uint8_t>(tally[kLabelCount + 1][x] + (hidden ? faces : 0));
      }
      if (std::memcmp(now + 1, here + 1, kSide) == 0) continue;
      for (std::size_t x = 1; x <= kSide; ++x) {
        if (now[x] == here[x]) continue;
        const std::size_t slot = slots[0][x] + slots[1][y + 1] + slots[2][z + 1];
        labels[slot] = static_cast<Label>(now[x]);
        if (here[x] != byte(kFreshlyOccluded)) {
          changed_slots.push_back(static_cast<std::uint32_t>(slot));
        }
      }
    }
    for (std::size_t kind = 1; kind < sums.size(); ++kind) {
      for (std::size_t x = 0; x < kRow; ++x) {
        sums[kind][x] = static_cast<std::uint16_t>(sums[kind][x] + tally[kind][x]);
      }
    }
  }

  Counts counts;
  const auto total = [&](std::size_t kind) {
    unsigned sum = 0;
    for (std::size_t x = 1; x <= kSide; ++x) sum += sums[kind][x];
    return static_cast<std::uint16_t>(sum);
  };
  for (std::size_t label = 1; label < kLabelCount; ++label) counts.voxels[label] = total(label);
  counts.occupied_faces = total(kLabelCount);
  counts.occlusion_plane_faces = total(kLabelCount + 1);
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
