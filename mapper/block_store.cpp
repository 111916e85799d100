#include "mapper/block_store.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace nextview {

namespace {

VoxelIndex block_of(const VoxelIndex& voxel) { return voxel.unaryExpr(&block_of_index); }

int wrapped(int index, int count) { return (index % count + count) % count; }

MapWindow of_block() { return {VoxelIndex::Zero(), VoxelIndex::Constant(kBlockSide)}; }

// The labels as bytes, x fastest.
LabelBytes bytes_of(const OpenBlock& block) {
  LabelBytes bytes;
  std::size_t entry = 0;
  for_each_voxel(of_block(), [&](const VoxelIndex& offset) {
    bytes[entry++] = static_cast<std::uint8_t>(label_in(block, offset));
  });
  return bytes;
}

BlockContent content_of(const OpenBlock& block, const std::vector<SurfaceVoxel>& surfaces) {
  BlockContent content{bytes_of(block), {}};
  content.surfaces.reserve(surfaces.size());
  for_each_voxel(of_block(), [&](const VoxelIndex& offset) {
    const VoxelBit at(offset);
    if (!at.is_in(block.labels.occupied)) return;
    content.surfaces.push_back(surfaces[at.rank_in(block.labels.occupied)]);
  });
  return content;
}

void hash_if_stale(OpenBlock& block) {
  if (!block.is_stale) return;
  block.is_stale = false;
  block.hash = block_hash(block.coordinate, bytes_of(block), [&](std::size_t entry) {
    const auto v = static_cast<int>(entry);
    const VoxelBit voxel(VoxelIndex(v, v / kBlockSide, v / (kBlockSide * kBlockSide)));
    return &block.surfaces[voxel.rank_in(block.labels.occupied)];
  });
}

}  // namespace

std::size_t VoxelBit::rank_in(const BlockBits& bits) const {
  int rank = std::popcount(bits[word] & (bit - 1));
  for (std::size_t before = 0; before < word; ++before) rank += std::popcount(bits[before]);
  return static_cast<std::size_t>(rank);
}

Label label_in(const OpenBlock& block, const VoxelIndex& voxel) {
  const VoxelBit at(voxel);
  if (at.is_in(block.labels.occupied)) return Label::Occupied;
  if (at.is_in(block.labels.empty)) return Label::Empty;
  if (at.is_in(block.labels.occlusion_plane)) return Label::OcclusionPlane;
  return at.is_in(block.labels.hidden) ? Label::Occluded : Label::Unmarked;
}

BlockStore::BlockStore(const MapWindow& extent, const VoxelIndex& window_size) {
  const VoxelIndex last = block_of(extent.min + extent.size - VoxelIndex::Ones());
  extent_.min = block_of(extent.min);
  extent_.size = last - extent_.min + VoxelIndex::Ones();
  const VoxelIndex rounded_up = window_size + VoxelIndex::Constant(kBlockSide - 1);
  open_ = {extent_.min, block_of(rounded_up).cwiseMin(extent_.size)};
  window_.resize(static_cast<std::size_t>(open_.size.cast<std::int64_t>().prod()));
  for_each_voxel(open_, [this](const VoxelIndex& coordinate) { enter(coordinate); });
  far_numbers_.clear(0);
}

MapWindow BlockStore::window() const { return {kBlockSide * open_.min, kBlockSide * open_.size}; }

std::size_t BlockStore::place(const VoxelIndex& coordinate) const {
  const auto along = [&](int axis) { return wrapped(coordinate[axis], open_.size[axis]); };
  return static_cast<std::size_t>(along(0)) +
         static_cast<std::size_t>(open_.size[0]) *
             (static_cast<std::size_t>(along(1)) +
              static_cast<std::size_t>(open_.size[1]) * static_cast<std::size_t>(along(2)));
}

void BlockStore::follow(const VoxelIndex& voxel) {
  const VoxelIndex block = block_of(voxel);
  MapWindow moved = open_;
  for (int axis = 0; axis < 3; ++axis) {
    const int size = open_.size[axis];
    const int into = block[axis] - open_.min[axis];
    if (into >= size / 4 && into < size - size / 4) continue;
    const int last = extent_.min[axis] + extent_.size[axis] - size;
    moved.min[axis] = std::clamp(block[axis] - size / 2, extent_.min[axis], last);
  }
  for (const MapWindow& left : left_behind(open_, moved.min)) {
    for_each_voxel(left, [&](const VoxelIndex& at) { leave(window_[place(at)]); });
  }
  std::swap(open_, moved);
  for (const MapWindow& entered : left_behind(open_, moved.min)) {
    for_each_voxel(entered, [&](const VoxelIndex& at) { enter(at); });
  }
}

BlockStore::AsideBlock BlockStore::packed(OpenBlock& block) {
  hash_if_stale(block);
  AsideBlock aside{PackedBlock(block.labels), std::move(block.surfaces), block.counts, block.hash,
                   block.changed_in};
  aside.surfaces.shrink_to_fit();
  return aside;
}

void BlockStore::unpack(const AsideBlock& aside, OpenBlock& block) {
  block.labels = aside.labels.labels();
  block.counted_empty = block.labels.empty;
  block.counts = aside.counts;
  block.hash = aside.hash;
  block.changed_in = aside.changed_in;
  block.is_marked = true;
}

void BlockStore::leave(OpenBlock& block) {
  if (block.is_marked) aside_.insert_or_assign(key(block.coordinate), packed(block));
}

void BlockStore::enter(const VoxelIndex& coordinate) {
  OpenBlock& block = window_[place(coordinate)];
  block = OpenBlock();
  block.coordinate = coordinate;
  auto aside = aside_.extract(key(coordinate));
  if (aside.empty()) return;
  unpack(aside.mapped(), block);
  block.surfaces = std::move(aside.mapped().surfaces);
}

OpenBlock& BlockStore::open(const VoxelIndex& coordinate) {
  if (open_.contains(coordinate)) return window_[place(coordinate)];
  std::uint64_t number = 0;  // 20 bits an axis hold a coordinate of the extent
  for (int axis = 0; axis < 3; ++axis) {
    number = number << 20 | static_cast<std::uint64_t>(coordinate[axis] - extent_.min[axis]);
  }
  const std::uint32_t place = far_numbers_.number_of(number);
  if (place < far_.size()) return far_[place];
  OpenBlock& block = far_.emplace_back();
  block.coordinate = coordinate;
  const auto aside = aside_.find(key(coordinate));
  if (aside != aside_.end()) {
    unpack(aside->second, block);
    block.surfaces = aside->second.surfaces;
  }
  return block;
}

OpenBlock* BlockStore::open_marked(const VoxelIndex& coordinate) {
  if (!extent_.contains(coordinate)) return nullptr;
  OpenBlock& block = open(coordinate);
  return block.is_marked ? &block : nullptr;
}

void BlockStore::close_far() {
  for (OpenBlock& block : far_) {
    if (block.is_stale) aside_.insert_or_assign(key(block.coordinate), packed(block));
  }
  far_.clear();
  far_numbers_.clear(0);
}

Label BlockStore::label(const VoxelIndex& voxel) const {
  const VoxelIndex coordinate = block_of(voxel);
  if (open_.contains(coordinate)) return label_in(window_[place(coordinate)], voxel);
  const auto aside = aside_.find(key(coordinate));
  if (aside == aside_.end()) return Label::Unmarked;
  OpenBlock block;
  unpack(aside->second, block);
  return label_in(block, voxel);
}

const SurfaceVoxel* BlockStore::surface(const VoxelIndex& voxel) const {
  const VoxelIndex coordinate = block_of(voxel);
  const auto find = [&](const BlockBits& occupied, const std::vector<SurfaceVoxel>& surfaces) {
    const VoxelBit at(voxel);
    return at.is_in(occupied) ? &surfaces[at.rank_in(occupied)] : nullptr;
  };
  if (open_.contains(coordinate)) {
    const OpenBlock& block = window_[place(coordinate)];
    return find(block.labels.occupied, block.surfaces);
  }
  const auto aside = aside_.find(key(coordinate));
  if (aside == aside_.end()) return nullptr;
  return find(aside->second.labels.labels().occupied, aside->second.surfaces);
}

BlockContent BlockStore::content(const VoxelIndex& coordinate) const {
  if (open_.contains(coordinate)) {
    const OpenBlock& block = window_[place(coordinate)];
    return content_of(block, block.surfaces);
  }
  const auto aside = aside_.find(key(coordinate));
  if (aside == aside_.end()) return {};
  OpenBlock block;
  unpack(aside->second, block);
  return content_of(block, aside->second.surfaces);
}

template <class OfOpen, class OfAside>
void BlockStore::for_each_marked(OfOpen of_open, OfAside of_aside) const {
  auto aside = aside_.begin();
  for_each_voxel(open_, [&](const VoxelIndex& coordinate) {
    const OpenBlock& block = window_[place(coordinate)];
    if (!block.is_marked) return;
    for (; aside != aside_.end() && aside->first < key(coordinate); ++aside) {
      of_aside(aside->first, aside->second);
    }
    of_open(block);
  });
  for (; aside != aside_.end(); ++aside) of_aside(aside->first, aside->second);
}

std::vector<VoxelIndex> BlockStore::changed_after(int changed_in) const {
  std::vector<VoxelIndex> changed;
  for_each_marked(
      [&](const OpenBlock& block) {
        if (block.changed_in > changed_in) changed.push_back(block.coordinate);
      },
      [&](const Key& key, const AsideBlock& block) {
        if (block.changed_in > changed_in) changed.emplace_back(key[2], key[1], key[0]);
      });
  return changed;
}

void BlockStore::hash(HashOfBlocks& whole) {
  for (OpenBlock& block : window_) {
    if (block.is_marked) hash_if_stale(block);
  }
  for_each_marked([&](const OpenBlock& block) { whole.add(block.hash); },
                  [&](const Key&, const AsideBlock& block) { whole.add(block.hash); });
}

std::size_t BlockStore::memory_bytes() const {
  constexpr std::size_t kOfNode = 4 * sizeof(void*);  // besides its value
  const auto of_surfaces = [](const auto& block) {
    return block.surfaces.capacity() * sizeof(SurfaceVoxel);
  };
  std::size_t bytes = (window_.capacity() + far_.size()) * sizeof(OpenBlock) +
                      far_numbers_.memory_bytes() +
                      aside_.size() * (kOfNode + sizeof(decltype(aside_)::value_type));
  for (const OpenBlock& block : window_) bytes += of_surfaces(block);
  for (const OpenBlock& block : far_) bytes += of_surfaces(block);
  for (const auto& [_, block] : aside_) bytes += block.labels.memory_bytes() + of_surfaces(block);
  return bytes;
}

}  // namespace nextview
