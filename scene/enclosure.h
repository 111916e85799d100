#pragma once

#include <Eigen/Core>

#include "scene/scene.h"

namespace nextview {

/// Share in [0, 1] of a fixed set of evenly spread directions that meet no surface: 0 in a closed
/// scene.
double escape_share(const Scene& scene, const Eigen::Vector3d& position_m);

/// Volume seen from a position inside the scene's bounds, in the same directions and up to the
/// bounds where they meet no surface. From inside a piece of furniture it is very small, whether
/// the furniture has a bottom or not.
double visible_volume_m3(const Scene& scene, const Eigen::Vector3d& position_m);

}  // namespace nextview
