#pragma once

#include <fmt/format.h>
#include <xxhash.h>

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "mapper/reference_map_update.h"

namespace nextview {

/// The digest of a map to the letter of map_digest.h, every voxel of every block looked at: the
/// plain twin of MapDigest.
inline std::string plain_digest(const ReferenceMapUpdate& map, const MapWindow& window) {
  const auto put = [](auto value, std::vector<unsigned char>& bytes) {
    const auto bits = static_cast<std::make_unsigned_t<decltype(value)>>(value);
    for (std::size_t byte = 0; byte < sizeof(value); ++byte) {
      bytes.push_back(static_cast<unsigned char>(bits >> (8 * byte)));
    }
  };
  const auto block_of = [](const VoxelIndex& v) { return v.unaryExpr(&block_of_index); };
  const VoxelIndex first = block_of(window.min);
  const VoxelIndex last = block_of(window.min + window.size - VoxelIndex::Ones());
  std::vector<unsigned char> hashes;
  for_each_voxel({first, last - first + VoxelIndex::Ones()}, [&](const VoxelIndex& block) {
    std::vector<unsigned char> bytes;
    std::vector<unsigned char> surfaces;
    bool is_marked = false;
    for (int axis = 0; axis < 3; ++axis) put(static_cast<std::int32_t>(block[axis]), bytes);
    for_each_voxel({kBlockSide * block, VoxelIndex::Constant(kBlockSide)},
                   [&](const VoxelIndex& v) {
                     const Label label = map.label(v);
                     is_marked |= label != Label::Unmarked;
                     put(static_cast<std::uint8_t>(label), bytes);
                     if (label != Label::Occupied) return;
                     const SurfaceVoxel* const kept = map.surface(v);
                     const SurfaceVoxel surface = kept == nullptr ? SurfaceVoxel() : *kept;
                     for (const std::int64_t sum : surface.normal_sum) put(sum, surfaces);
                     put(surface.normal_count, surfaces);
                     put(surface.quality, surfaces);
                   });
    if (!is_marked) return;
    bytes.insert(bytes.end(), surfaces.begin(), surfaces.end());
    const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
    for (const std::uint64_t half : {hash.high64, hash.low64}) {  // canonical: big-endian
      for (int byte = 7; byte >= 0; --byte) {
        hashes.push_back(static_cast<unsigned char>(half >> (8 * byte)));
      }
    }
  });
  const XXH128_hash_t whole = XXH3_128bits(hashes.data(), hashes.size());
  return fmt::format("{:016x}{:016x}", whole.high64, whole.low64);
}

}  // namespace nextview
