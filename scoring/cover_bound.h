#pragma once

#include <stop_token>

#include "scoring/cover_prices.h"
#include "scoring/cover_sets.h"

namespace nextview {

struct CoverBoundParameters {
  int most_rounds = 80;             ///< of column generation
  std::size_t poses_a_round = 300;  ///< added to the programme at most
  std::size_t alike = 40;           ///< poses of which one at a time is added
  /// For more voxels, which are its rows, the programme is too large: then bound_by_prices.
  std::size_t most_voxels = 20'000;
  CoverPriceParameters prices = {};
};

/// A lower bound on the number of poses that together cover a share of all weight: the value, or a
/// little less, of the linear relaxation of the partial cover
///
///   least sum x_p   such that   z_v <= sum over poses p that cover v of x_p,   0 <= z_v <= 1,
///                               sum w_v z_v >= share * sum w_v,   x_p >= 0.
///
/// Solved over some of the poses, and for the others their price is looked at: with the dual values
/// y_v of the rows, divided by the largest sum of y_v over a pose's voxels, the dual programme of
/// all poses is feasible, so that the value so far divided by the same is a lower bound however
/// soon one stops (Farley's bound). With many voxels the dual values are those of bound_by_prices.
/// @param first poses that are taken in any case, and not counted in the bound
/// @return poses besides the first ones, not rounded; 0 when they are enough
/// @throws std::invalid_argument when all poses together do not cover the share
double fewest_poses(const CoverSets& sets, std::span<const std::size_t> first, double share,
                    const CoverBoundParameters& parameters = {}, const std::stop_token& stop = {},
                    WorkProgress* progress = nullptr);

}  // namespace nextview
