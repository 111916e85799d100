#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "viewer/spill_file.h"

namespace nextview {

/// The surface voxels of every block as they were after every view. A view adds the blocks it has
/// changed; what they hold lies in a file, and memory holds where: 16 bytes a changed block, with
/// the room a vector keeps to grow at most twice that.
class BlockHistory {
 public:
  /// @param file must outlive this
  explicit BlockHistory(SpillFile& file) : file_(file) {}

  /// What a block holds from a view on; nothing happens when that is what it held before.
  /// @param view from 1, never less than one before
  /// @param number of the block, by which it is known from view to view
  /// @param coordinate in blocks
  void add(int view, std::uint32_t number, const std::array<std::int16_t, 3>& coordinate,
           std::span<const std::uint8_t> surface);

  /// Blocks are listed as they came; a block keeps its place in the list.
  std::size_t blocks() const { return blocks_.size(); }
  const std::array<std::int16_t, 3>& coordinate(std::size_t block) const {
    return blocks_[block].coordinate;
  }
  /// The view since which a block holds what it holds after `view`; 0: it holds nothing yet.
  int since(std::size_t block, int view) const;
  /// Bytes of what it holds then, and these bytes themselves, appended to `out`.
  std::size_t bytes(std::size_t block, int view) const;
  void read(std::size_t block, int view, std::vector<std::uint8_t>& out) const;

  std::size_t memory_bytes() const;

 private:
  struct Version {
    std::uint64_t offset;
    std::uint32_t bytes;
    std::int32_t view;
  };
  struct Block {
    std::array<std::int16_t, 3> coordinate;
    std::uint64_t hash;  ///< of the last version
    std::vector<Version> versions;
  };
  const Version* version(std::size_t block, int view) const;

  SpillFile& file_;
  std::unordered_map<std::uint32_t, std::uint32_t> place_of_number_;
  std::vector<Block> blocks_;
};

}  // namespace nextview
