#include "mapper/block_history.h"

namespace nextview {

BlockHistory::BlockHistory(const VoxelMap& map) : blocks_(map), changed_in_(blocks_.size()) {}

void BlockHistory::view_folded(int view, const FoldReport& report) {
  for (const auto* slots : {&report.changed_slots, &report.updated_surfaces}) {
    of_changes_.resize(slots->size());
    blocks_.blocks_of(*slots, of_changes_.data());
    for (const std::uint32_t block : of_changes_) changed_in_[block] = view;
  }
}

std::vector<std::uint32_t> BlockHistory::changed_since(int view) const {
  std::vector<std::uint32_t> changed;
  blocks_.for_each_in_order([&](std::uint32_t block) {
    if (changed_in_[block] > view) changed.push_back(block);
  });
  return changed;
}

}  // namespace nextview
