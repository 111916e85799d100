#include "mapper/map_census.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace nextview {

namespace {

constexpr std::size_t kSide = kBlockSide;
using Slots = std::array<MapBlocks::AxisSlots, 3>;

constexpr std::uint8_t byte(Label label) { return static_cast<std::uint8_t>(label); }

// The rows of a block are read and written as words.
static_assert(std::endian::native == std::endian::little);

bool is_whole(const MapBlocks::AxisSlots& xs) {
  return xs[0] != MapBlocks::kOutside && xs[kSide - 1] - xs[0] == kSide - 1;
}

// A row of labels whose first voxel would lie at from[0], voxels outside the window left out.
std::uint64_t read_row(const Label* from, const MapBlocks::AxisSlots& xs) {
  std::uint64_t row = 0;
  if (is_whole(xs)) {
    std::memcpy(&row, from + xs[0], kSide);
    return row;
  }
  for (std::size_t x = 0; x < kSide; ++x) {
    if (xs[x] != MapBlocks::kOutside) row |= std::uint64_t{byte(from[xs[x]])} << (8 * x);
  }
  return row;
}

// Reads the labels of a block.
void read_rows(std::span<const Label> labels, const Slots& slots, BlockRows& rows) {
  const auto& [xs, ys, zs] = slots;
  for (std::size_t z = 0; z < kSide; ++z) {
    for (std::size_t y = 0; y < kSide; ++y) {
      std::uint64_t& row = rows[kSide * y + z];
      row = 0;
      if (ys[y] == MapBlocks::kOutside || zs[z] == MapBlocks::kOutside) continue;
      row = read_row(labels.data() + ys[y] + zs[z], xs);
    }
  }
}

}  // namespace

MapCensus::MapCensus(const VoxelMap& map, const MapBlocks& blocks)
    : counts_(blocks.size()),
      empty_(std::size_t{blocks.size()} + 1),
      hidden_(blocks.size()),
      listed_(blocks.size()),
      totals_(map.window()) {}

void MapCensus::note_changes(const MapBlocks& blocks, std::span<const std::uint32_t> slots) {
  std::array<std::uint32_t, 256> portion;
  for (std::size_t begin = 0; begin < slots.size(); begin += portion.size()) {
    const auto these = slots.subspan(begin, std::min(portion.size(), slots.size() - begin));
    blocks.blocks_of(these, portion.data());
    for (const std::uint32_t block : std::span(portion).first(these.size())) list(block);
  }
}

void MapCensus::note_leaving(const MapBlocks& blocks, std::uint32_t block) {
  list(block);
  // Once it has left, nobody knows any more what lay beside it.
  list_neighbours(blocks, block, sides_touched(empty_[block]));
}

void MapCensus::list_neighbours(const MapBlocks& blocks, std::uint32_t block, unsigned sides) {
  if (sides == 0) return;
  const auto neighbours = blocks.neighbours(block);
  for (std::size_t side = 0; side < 6; ++side) {
    const std::uint32_t neighbour = neighbours[side];
    if ((sides >> side & 1) != 0 && neighbour != blocks.size()) list(neighbour);
  }
}

void MapCensus::take_labels(const VoxelMap& map, const MapBlocks& blocks, std::uint32_t block) {
  BlockRows rows;
  read_rows(map.labels(), blocks.slots(block), rows);
  LookedAt& at = labels_.emplace_back();
  at.block = block;
  sort_by_label(rows, at.labels);
}

std::span<const std::uint32_t> MapCensus::update(VoxelMap& map, const MapBlocks& blocks,
                                                 std::vector<std::uint32_t>& changed_slots) {
  // Blocks next to each other along x share cache lines.
  std::sort(to_look_.begin(), to_look_.end());
  labels_.clear();
  for (std::size_t n = 0; n < to_look_.size(); ++n) {  // which grows
    const std::uint32_t block = to_look_[n];
    take_labels(map, blocks, block);
    const BlockBits& empty = labels_.back().labels.empty;
    BlockBits differs;
    for (std::size_t z = 0; z < kSide; ++z) differs[z] = empty[z] ^ empty_[block][z];
    empty_[block] = empty;
    list_neighbours(blocks, block, sides_touched(differs));
  }
  for (LookedAt& at : labels_) {
    totals_.take_away(counts_[at.block]);
    counts_[at.block] = derive(map, blocks, at, changed_slots);
    hidden_[at.block] = at.labels.hidden;
    totals_.add(counts_[at.block]);
    listed_[at.block] = 0;
  }
  looked_.swap(to_look_);
  to_look_.clear();
  return looked_;
}

BlockCounts MapCensus::derive(VoxelMap& map, const MapBlocks& blocks, LookedAt& at,
                              std::vector<std::uint32_t>& changed_slots) const {
  BlockLabels& labels = at.labels;
  std::array<const BlockBits*, 6> beyond;  // the last of empty_ stands for what is not there
  const auto neighbours = blocks.neighbours(at.block);
  for (std::size_t side = 0; side < 6; ++side) beyond[side] = &empty_[neighbours[side]];
  EmptyNeighbours open;
  find_empty_neighbours(labels, beyond, open);

  BlockBits planes;
  BlockBits changed;
  for (std::size_t z = 0; z < kSide; ++z) {
    planes[z] = labels.hidden[z] & open.any[z];
    changed[z] = planes[z] ^ labels.occlusion_plane[z];
  }
  if (changed != BlockBits{}) {
    const auto [xs, ys, zs] = blocks.slots(at.block);
    for (std::size_t z = 0; z < kSide; ++z) {
      for (std::uint64_t left = changed[z]; left != 0; left &= left - 1) {
        const auto bit = static_cast<std::size_t>(std::countr_zero(left));
        const std::size_t slot = xs[bit / kSide] + ys[bit % kSide] + zs[z];
        map.labels()[slot] = planes[z] >> bit & 1 ? Label::OcclusionPlane : Label::Occluded;
        // One that was not hidden before has been noted by whoever marked it.
        if (hidden_[at.block][z] >> bit & 1) {
          changed_slots.push_back(static_cast<std::uint32_t>(slot));
        }
      }
    }
  }

  labels.occlusion_plane = planes;
  return counts_of(labels, open);
}

std::size_t MapCensus::memory_bytes() const {
  return counts_.memory_bytes() + empty_.memory_bytes() + hidden_.memory_bytes() +
         listed_.memory_bytes() +
         (to_look_.capacity() + looked_.capacity()) * sizeof(std::uint32_t) +
         labels_.capacity() * sizeof(LookedAt);
}

}  // namespace nextview
