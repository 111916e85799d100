#include "mapper/map_digest.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <memory>
#include <new>
#include <type_traits>

namespace nextview {

namespace {

constexpr std::size_t kSurfaceBytes = 3 * 8 + 4 + 2;
constexpr std::size_t kMaxBlockBytes = 3 * 4 + kBlockVoxels * (1 + kSurfaceBytes);

// The bytes of one block, in a buffer on the stack.
class BlockBytes {
 public:
  template <typename Integer>
  void put(Integer value) {
    const auto bits = static_cast<std::make_unsigned_t<Integer>>(value);
    for (std::size_t byte = 0; byte < sizeof(Integer); ++byte) {
      bytes_[size_++] = static_cast<unsigned char>(bits >> (8 * byte));
    }
  }
  const unsigned char* begin() const { return bytes_; }
  std::size_t size() const { return size_; }

 private:
  unsigned char bytes_[kMaxBlockBytes];
  std::size_t size_ = 0;
};

void put_surface(const SurfaceVoxel* surface, BlockBytes& bytes) {
  static constexpr SurfaceVoxel kNothing;
  const SurfaceVoxel& voxel = surface == nullptr ? kNothing : *surface;
  for (const std::int64_t sum : voxel.normal_sum) bytes.put(sum);
  bytes.put(voxel.normal_count);
  bytes.put(voxel.quality);
}

// The labels of a block as bytes, x fastest; Unmarked where it sticks out of the window.
using BlockLabels = std::array<std::uint8_t, kBlockVoxels>;

BlockLabels labels_of(const VoxelMap& map, const MapBlocks& blocks, std::uint32_t block) {
  constexpr std::size_t kSide = kBlockSide;
  BlockLabels bytes = {};
  const auto [xs, ys, zs] = blocks.slots(block);
  for (std::size_t row = 0; row < kSide * kSide; ++row) {
    const std::size_t y = ys[row % kSide];
    const std::size_t z = zs[row / kSide];
    if (y == MapBlocks::kOutside || z == MapBlocks::kOutside) continue;
    const Label* const from = map.labels().data() + y + z;
    for (std::size_t x = 0; x < kSide; ++x) {
      const std::size_t slot = xs[x];
      if (slot != MapBlocks::kOutside) {
        bytes[row * kSide + x] = static_cast<std::uint8_t>(from[slot]);
      }
    }
  }
  return bytes;
}

// Writes a block's content; false when all of it is Unmarked.
bool serialise(const VoxelMap& map, const MapBlocks& blocks, std::uint32_t block,
               BlockBytes& bytes) {
  const BlockLabels labels = labels_of(map, blocks, block);
  static constexpr BlockLabels kAllUnmarked = {};
  if (labels == kAllUnmarked) return false;

  const VoxelIndex coordinate = blocks.coordinate(block);
  for (int axis = 0; axis < 3; ++axis) bytes.put(static_cast<std::int32_t>(coordinate[axis]));
  for (const std::uint8_t label : labels) bytes.put(label);
  for (int v = 0; v < kBlockVoxels; ++v) {
    if (labels[static_cast<std::size_t>(v)] != static_cast<std::uint8_t>(Label::Occupied)) continue;
    const VoxelIndex offset(v % kBlockSide, v / kBlockSide % kBlockSide,
                            v / (kBlockSide * kBlockSide));
    put_surface(map.surface(kBlockSide * coordinate + offset), bytes);
  }
  return true;
}

using Hash = std::array<unsigned char, 16>;

Hash canonical(const XXH128_hash_t& hash) {
  XXH128_canonical_t bytes;
  XXH128_canonicalFromHash(&bytes, hash);
  return std::to_array(bytes.digest);
}

struct FreeState {
  void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
};

}  // namespace

MapDigest::MapDigest(const MapBlocks& blocks)
    : hashes_(blocks.size()), present_(blocks.size(), 0), stale_(blocks.size(), 0) {}

std::string MapDigest::digest(const VoxelMap& map, const MapBlocks& blocks) {
  // Blocks next to each other along x share cache lines.
  std::sort(to_hash_.begin(), to_hash_.end());
  for (const std::uint32_t block : to_hash_) {
    BlockBytes bytes;
    present_[block] = serialise(map, blocks, block, bytes) ? 1 : 0;
    if (present_[block]) {
      hashes_[block] = canonical(XXH3_128bits(bytes.begin(), bytes.size()));
    }
    stale_[block] = 0;
  }
  to_hash_.clear();

  const std::unique_ptr<XXH3_state_t, FreeState> state(XXH3_createState());
  if (state == nullptr) throw std::bad_alloc();
  XXH3_128bits_reset(state.get());
  blocks.for_each_in_order([&](std::uint32_t block) {
    if (present_[block]) {
      XXH3_128bits_update(state.get(), hashes_[block].data(), sizeof(Hash));
    }
  });
  const XXH128_hash_t whole = XXH3_128bits_digest(state.get());
  return fmt::format("{:016x}{:016x}", whole.high64, whole.low64);
}

std::size_t MapDigest::memory_bytes() const {
  return hashes_.capacity() * sizeof(Hash) + present_.capacity() + stale_.capacity() +
         to_hash_.capacity() * sizeof(to_hash_[0]);
}

std::string map_digest(const VoxelMap& map) {
  const MapBlocks blocks(map);
  MapDigest digest(blocks);
  for (std::uint32_t block = 0; block < blocks.size(); ++block) digest.invalidate(block);
  return digest.digest(map, blocks);
}

}  // namespace nextview
