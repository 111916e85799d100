#pragma once

#include <numbers>

#include "sensor/ray_table.h"

namespace nextview {

/// A line striper (P5): a mirror turns a sheet of light about the sensor's z axis, and a camera
/// beside it sees where the sheet falls: a stripe, of which each row of the camera gives a point.
/// Column u is the stripe u from the left, row v the camera's from the top. Stripes lie at even
/// angles, as the mirror turns; rows at even tangents, as a flat picture has them:
///
///     n_uv = Rz(phi_u) Rx(theta_v) y = (-sin phi_u cos theta_v, cos phi_u cos theta_v, sin
///     theta_v), phi_u = phi (1/2 - u/(N-1)),   tan theta_v = tan(theta/2) (1 - 2 v/(M-1)).
///
/// All rays start at the mirror, the optical centre. The camera stands baseline_m to the right of
/// it, along the sensor's x axis: a point the light reaches and the camera cannot see has no valid
/// range (sensor_sim/camera_shadow.h). A sheet that is carried along in place of turned has no one
/// centre and does not fit (ray_table.h).
struct LineStriper {
  int columns = 256;                                    ///< N, stripes
  int rows = 200;                                       ///< M, points of a stripe
  double sweep_rad = std::numbers::pi / 3.0;            ///< phi, in (0, pi)
  double vertical_aperture_rad = std::numbers::pi / 4;  ///< theta, of the camera, in (0, pi)
  double baseline_m = 0.1;                              ///< of 0 or more
};

/// @throws std::invalid_argument unless columns and rows are 2 to 4096, both angles in range and
/// the
///         baseline within its bounds
RayTable make_ray_table(const LineStriper& sensor);

}  // namespace nextview
