#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "mapper/voxel_map.h"

namespace nextview {

/// The hash of a block's content, as map_digest.h says; in canonical bytes.
using BlockHash = std::array<unsigned char, 16>;
/// The labels of a block as bytes, x fastest.
using LabelBytes = std::array<std::uint8_t, kBlockVoxels>;
constexpr LabelBytes kAllUnmarked = {};

/// The bytes a block is hashed by, in a buffer on the stack.
class BlockBytes {
 public:
  BlockBytes(const VoxelIndex& coordinate, const LabelBytes& labels);
  void put_surface(const SurfaceVoxel* surface);
  BlockHash hash() const;

 private:
  template <typename Integer>
  void put(Integer value);

  static constexpr std::size_t kSurfaceBytes = 3 * 8 + 4 + 2;
  unsigned char bytes_[3 * 4 + kBlockVoxels * (1 + kSurfaceBytes)];
  std::size_t size_ = 0;
};

/// @param coordinate of the block, absolute
/// @param surface_of (entry of labels) -> surface data of an Occupied voxel, or nullptr
template <typename SurfaceOf>
BlockHash block_hash(const VoxelIndex& coordinate, const LabelBytes& labels, SurfaceOf surface_of) {
  BlockBytes bytes(coordinate, labels);
  for (std::size_t entry = 0; entry < labels.size(); ++entry) {
    if (labels[entry] == static_cast<std::uint8_t>(Label::Occupied)) {
      bytes.put_surface(surface_of(entry));
    }
  }
  return bytes.hash();
}

/// The digest of a map from the hashes of its blocks that are not all Unmarked, in the order of
/// their coordinates.
class HashOfBlocks {
 public:
  HashOfBlocks();
  ~HashOfBlocks();
  HashOfBlocks(const HashOfBlocks&) = delete;
  HashOfBlocks& operator=(const HashOfBlocks&) = delete;

  void add(const BlockHash& hash);
  std::string hex_digits() const;  ///< 32 of them

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nextview
