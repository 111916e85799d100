#pragma once

#include "lcmtypes/channels.h"
#include "mapper/map_statistics.h"
#include "sensor/range_image_message.h"

namespace nextview {

/// What there is to say of a range image that has been folded, apart from the digests and the
/// number of the run.
/// @param folded what the fold did
/// @param statistics of the map after it
commit_t commit_message(const ReceivedRangeImage& received, const FoldCounts& folded,
                        const MapStatistics& statistics);

}  // namespace nextview
