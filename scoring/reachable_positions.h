#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <stop_token>
#include <vector>

#include "scene/scene.h"
#include "scoring/work_progress.h"

namespace nextview {

/// Where a robot may be: for scoring, which knows the CAD.
struct ReachParameters {
  double spacing_m = 0.10;      ///< of the lattice of positions
  double clearance_m = 0.40;    ///< a position or path is free when no surface is nearer
  double join_within_m = 0.25;  ///< how far from the start the lattice begins at most
  Eigen::Vector3d box_min_m = Eigen::Vector3d::Zero();  ///< workspace and lift limits
  Eigen::Vector3d box_max_m = Eigen::Vector3d::Zero();
  std::int64_t most_positions = 10'000'000;  ///< a lattice of more is refused
};

/// The positions of the world's lattice that a robot can get to.
///
/// The lattice has a point at the world's origin and knows nothing of the start: its points inside
/// the box that keep the clearance are joined to those of their 26 neighbours to which the straight
/// piece keeps it too. What is returned is the whole connected part that the start joins, which is
/// that of the nearest point it gets to in a straight free piece; so it is the same from every
/// start in it. In a fixed order (by z, y, x); empty when the start joins nothing, and when stop is
/// requested.
/// @throws std::invalid_argument unless the spacing is positive and the numbers are finite
/// @throws CoverageUnknown for more than most_positions
std::vector<Eigen::Vector3d> reachable_positions(const Scene& scene, const Eigen::Vector3d& start_m,
                                                 const ReachParameters& parameters,
                                                 const std::stop_token& stop = {},
                                                 WorkProgress* progress = nullptr);

}  // namespace nextview
