#pragma once

#include <Eigen/Core>
#include <vector>

#include "scene/scene.h"

namespace nextview {

/// Where a robot may be: for scoring, which knows the CAD.
struct ReachParameters {
  double spacing_m = 0.25;    ///< of the grid of positions
  double clearance_m = 0.40;  ///< a position or path is free when no surface is nearer
  Eigen::Vector3d box_min_m = Eigen::Vector3d::Zero();  ///< workspace and lift limits
  Eigen::Vector3d box_max_m = Eigen::Vector3d::Zero();
};

/// All positions of a grid anchored at the start that a robot can get to: each inside the box, and
/// connected to the start by straight pieces along the grid's axes that keep the clearance. The
/// start comes first; only the start when it is not free itself.
/// @throws std::invalid_argument unless the spacing is positive and the numbers are finite
std::vector<Eigen::Vector3d> reachable_positions(const Scene& scene, const Eigen::Vector3d& start_m,
                                                 const ReachParameters& parameters);

}  // namespace nextview
