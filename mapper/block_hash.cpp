#include "mapper/block_hash.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <new>
#include <type_traits>

namespace nextview {

template <typename Integer>
void BlockBytes::put(Integer value) {
  const auto bits = static_cast<std::make_unsigned_t<Integer>>(value);
  for (std::size_t byte = 0; byte < sizeof(Integer); ++byte) {
    bytes_[size_++] = static_cast<unsigned char>(bits >> (8 * byte));
  }
}

BlockBytes::BlockBytes(const VoxelIndex& coordinate, const LabelBytes& labels) {
  for (int axis = 0; axis < 3; ++axis) put(static_cast<std::int32_t>(coordinate[axis]));
  for (const std::uint8_t label : labels) put(label);
}

void BlockBytes::put_surface(const SurfaceVoxel* surface) {
  static constexpr SurfaceVoxel kNothing;
  const SurfaceVoxel& voxel = surface == nullptr ? kNothing : *surface;
  for (const std::int64_t sum : voxel.normal_sum) put(sum);
  put(voxel.normal_count);
  put(voxel.quality);
}

BlockHash BlockBytes::hash() const {
  XXH128_canonical_t bytes;
  XXH128_canonicalFromHash(&bytes, XXH3_128bits(bytes_, size_));
  return std::to_array(bytes.digest);
}

struct HashOfBlocks::State {
  State() : hash(XXH3_createState()) {
    if (hash == nullptr) throw std::bad_alloc();
    XXH3_128bits_reset(hash);
  }
  ~State() { XXH3_freeState(hash); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  XXH3_state_t* hash;
};

HashOfBlocks::HashOfBlocks() : state_(std::make_unique<State>()) {}
HashOfBlocks::~HashOfBlocks() = default;

void HashOfBlocks::add(const BlockHash& hash) {
  XXH3_128bits_update(state_->hash, hash.data(), hash.size());
}

std::string HashOfBlocks::hex_digits() const {
  const XXH128_hash_t whole = XXH3_128bits_digest(state_->hash);
  return fmt::format("{:016x}{:016x}", whole.high64, whole.low64);
}

}  // namespace nextview
