#pragma once

#include "sensor/ray_table.h"

namespace nextview {

/// A tilted line scan sensor (paper eq. 5, P4): N columns by M rows, each row a line scan tilted
/// about the sensor's x axis. Column u from the left, row v from the top:
///
///     n_uv = R_a(alpha_u) Rx(beta_v) y,   a = Rx(beta_v) z,
///     alpha_u = alpha (1/2 - u/(N-1)),    beta_v = beta (1/2 - v/(M-1)).
struct TiltedLineScan {
  int columns = 64;                      ///< N
  int rows = 30;                         ///< M
  double horizontal_aperture_rad = 0.0;  ///< alpha, in (0, pi)
  double vertical_aperture_rad = 0.0;    ///< beta, in (0, pi)

  /// The paper's sensor: 64 x 30, alpha = 60 degrees, beta = atan((M/N) tan alpha) = 39.07 degrees.
  static TiltedLineScan paper();
  /// Any raster with the paper's relation between the two apertures: beta = atan((M/N) tan alpha).
  /// @throws std::invalid_argument unless columns, rows >= 2 and 0 < alpha < 90 degrees
  static TiltedLineScan with_aperture(int columns, int rows, double horizontal_aperture_rad);
};

/// @throws std::invalid_argument unless columns and rows are 2 to 4096 and both apertures in range
RayTable make_ray_table(const TiltedLineScan& sensor);

}  // namespace nextview
