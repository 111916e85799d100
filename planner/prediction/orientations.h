#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "sensor/random_stream.h"

namespace nextview {

/// One of the directions the sensor may look in (P20).
struct Orientation {
  double pan_rad = 0.0;                                  ///< atan2(-d_x, d_y)
  double tilt_rad = 0.0;                                 ///< asin(d_z)
  Eigen::Vector3d direction = Eigen::Vector3d::UnitY();  ///< d, the optical axis, world frame
};

/// The corners of a triangle on the unit sphere.
using SphereTriangle = std::array<Eigen::Vector3d, 3>;

/// The faces of an icosahedron, edge up: vertices (0, +-1, +-phi) and cyclic, normalised (P20).
/// With subdivisions, each face is divided into four at the middles of its edges, put back on the
/// sphere, again and again: 20, 80, 320, 1280, ... faces. The order is fixed, because ties between
/// views go to the lowest: a face's four parts follow each other in its place.
/// @throws std::invalid_argument unless 0 <= subdivisions <= 6
std::vector<SphereTriangle> icosahedron_faces(int subdivisions = 0);

/// The directions of the centres of those faces, in their order. None of them is vertical, so pan
/// is always defined: the poles stay corners or middles of edges however often faces are divided.
std::vector<Orientation> icosahedron_orientations(int subdivisions = 0);

/// A random direction inside a face: uniform over its flat triangle, put on the sphere (P21).
/// Draws two numbers.
Eigen::Vector3d random_direction_in(const SphereTriangle& face, RandomStream& random);

}  // namespace nextview
