#pragma once

#include <numbers>

#include "sensor/ray_table.h"

namespace nextview {

/// A spherical scanner (P5): a line scan that stands upright and is turned about the sensor's z
/// axis, up to a whole turn, so that columns are meridians and rows circles of latitude. Column u
/// from the left, row v from the top:
///
///     n_uv = Rz(phi_u) Rx(theta_v) y = (-sin phi_u cos theta_v, cos phi_u cos theta_v, sin
///     theta_v), phi_u = d ((N-1)/2 - u),     d = min(phi/(N-1), 2 pi/N), theta_v = theta (1/2 -
///     v/(M-1)).
///
/// So the first and the last column lie phi apart, unless that would bring them nearer to each
/// other than neighbours: a whole turn has N columns 2 pi/N apart, none of them twice.
///
/// It is eq. 5 with rows and columns exchanged and the frame turned by 90 degrees about y
/// (ray_table.h): a = -theta, b = phi.
struct SphericalScanner {
  int columns = 1000;                                         ///< N
  int rows = 250;                                             ///< M
  double horizontal_aperture_rad = 2.0 * std::numbers::pi;    ///< phi, in (0, 2 pi]
  double vertical_aperture_rad = std::numbers::pi * 5.0 / 9;  ///< theta, in (0, pi): no poles
};

/// @throws std::invalid_argument unless columns and rows are 2 to 4096 and both apertures in range
RayTable make_ray_table(const SphericalScanner& sensor);

}  // namespace nextview
