#pragma once

#include <stop_token>

#include "scoring/cover_sets.h"

namespace nextview {

/// The poses that somebody takes who knows what each would cover and always takes the one that adds
/// most (of equal ones the first), until a share of all weight is covered or nothing is added.
/// @param first poses taken before all others
/// @return all poses taken, in order, the first ones included
std::vector<std::size_t> greedy_cover(const CoverSets& sets, std::span<const std::size_t> first,
                                      double share, const std::stop_token& stop = {});

/// The share of all weight that poses cover together.
double share_covered(const CoverSets& sets, std::span<const std::size_t> poses);

}  // namespace nextview
