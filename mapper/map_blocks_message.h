#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lcmtypes/channels.h"
#include "mapper/block_history.h"
#include "mapper/paged_map_builder.h"

namespace nextview {

/// The blocks of a map that have changed since a view as they travel: in parts that keep within the
/// message limit, at least one.
/// @param view the map is as of after it
/// @param since_view from 0 to view
/// @param utime simulated, of the view
std::vector<map_blocks_t> map_blocks_messages(const VoxelMap& map, const BlockHistory& history,
                                              int view, int since_view, std::int64_t utime);
/// The same of a map of which only a window lies open, and the same messages to the last bit. Its
/// folds are the views, from 1.
std::vector<map_blocks_t> map_blocks_messages(const PagedMapBuilder& builder, int view,
                                              int since_view, std::int64_t utime);

}  // namespace nextview
