#pragma once

#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <vector>

#include "scoring/cover_sets.h"
#include "scoring/work_progress.h"

namespace nextview {

struct CoverPriceParameters {
  double fall = 0.05;     ///< of a voxel's price whenever a pose that covers it is taken
  int most_steps = 6000;  ///< poses taken
};

/// A lower bound on the number of poses that cover a weight, by prices: of a voxel y_v, of a pose
/// their sum over what it covers. Whoever covers enough pays at least
///
///     lambda * to_cover - sum over v of max(0, lambda w_v - y_v)      for any lambda,
///
/// and no pose costs more than the dearest; the one over the other is the bound, that of the dual
/// of the linear relaxation (see fewest_poses). Prices begin at w_v. The dearest pose is taken
/// again and again, and what it covers falls in price, so that in the end poses are about equally
/// dear (the multiplicative weights of Garg and Koenemann, FOCS 1998). Prices only fall, so the
/// dearest is found without asking all poses again. The best bound of all steps counts; of small
/// random covers it is within 3 % of the programme's in four of five.
/// @param done by voxel: covered already, and worth nothing
/// @param to_cover weight of the others that is to be covered
double bound_by_prices(const CoverSets& sets, const std::vector<std::uint8_t>& done,
                       double to_cover, const CoverPriceParameters& parameters = {},
                       const std::stop_token& stop = {}, WorkProgress* progress = nullptr);

}  // namespace nextview
