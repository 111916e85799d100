#pragma once

#include <Eigen/Core>
#include <vector>

#include "scene/scene.h"

namespace nextview {

/// What a robot needs to stand somewhere in a scene.
struct StandingParameters {
  double sensor_height_m = 1.2;  ///< of the sensor above the floor it stands on
  double clearance_m = 0.40;     ///< no surface nearer to the sensor
  double spacing_m = 0.5;        ///< of the columns looked at; larger in a very large scene
  int most_columns = 4000;
};

/// Where in a scene a robot could start, best first: sensor positions, each above a surface, clear
/// of everything and inside the scene. The best sees most of it: of the directions around it fewest
/// leave the scene, and then it sees the largest volume. A place within 1.5 m of a better one is
/// left out. On a lattice of columns about the scene's middle, in whole centimetres: the same for
/// the same scene. Looks at every storey and at table tops, which are floors as far as a scene
/// tells; those show less.
/// @param most places that are wanted
std::vector<Eigen::Vector3d> standing_places(const Scene& scene,
                                             const StandingParameters& parameters,
                                             std::size_t most);

}  // namespace nextview
