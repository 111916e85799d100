#pragma once

#include <cstdint>
#include <vector>

#include "mapper/map_builder.h"

namespace nextview {

/// The slots that a fold has made Occupied; they never become anything else.
inline std::vector<std::uint32_t> newly_occupied(const VoxelMap& map, const FoldReport& fold) {
  std::vector<std::uint32_t> slots;
  for (const std::uint32_t slot : fold.changed_slots) {
    if (map.labels()[slot] == Label::Occupied) slots.push_back(slot);
  }
  return slots;
}

}  // namespace nextview
