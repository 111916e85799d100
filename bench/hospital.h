#pragma once

#include <Eigen/Core>

#include "scene/triangle_mesh.h"

namespace nextview {

/// A storey of a hospital that nobody has built, 4000 m^2 of floor at its full size: corridors with
/// rooms on both sides, behind walls, doors and lintels that are boxes of their own as CAD programs
/// write them, so that much of the surface lies where two boxes touch. In each room beds, cupboards
/// or tables with legs, which the number of the room decides.
struct Hospital {
  int corridors = 4;        ///< each with two rows of rooms
  int rooms_in_a_row = 18;  ///< of 4.5 x 5 m
  TriangleMesh mesh() const;
  /// In the first corridor.
  static Eigen::Vector3d start_m() { return {1.2, 6.2, 1.2}; }
};

}  // namespace nextview
