#pragma once

#include <cstdint>
#include <vector>

#include "mapper/lazy_array.h"
#include "mapper/map_blocks.h"
#include "mapper/map_builder.h"

namespace nextview {

/// When each block of a map has last changed, in label or surface, for whoever follows the map in
/// steps. Of a map whose window stays where it is.
class BlockHistory {
 public:
  /// Of a map that is all Unmarked.
  explicit BlockHistory(const VoxelMap& map);

  /// Takes what a view has changed.
  /// @param view larger than those before, from 1
  void view_folded(int view, const FoldReport& report);

  /// Numbers (MapBlocks) of the blocks that have changed after a view, 0: ever, in the order of
  /// their coordinates, x fastest.
  std::vector<std::uint32_t> changed_since(int view) const;

  const MapBlocks& blocks() const { return blocks_; }

 private:
  MapBlocks blocks_;
  LazyArray<std::int32_t> changed_in_;     // by block: the view; 0: never
  std::vector<std::uint32_t> of_changes_;  // room for blocks_of
};

}  // namespace nextview
