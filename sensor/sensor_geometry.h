#pragma once

#include "sensor/ray_table.h"

namespace nextview {

/// A tilted line scan sensor (paper eq. 5, P4): N columns by M rows, each row a line scan tilted
/// about the sensor's x axis.
struct TiltedLineScan {
  int columns = 64;                      ///< N
  int rows = 30;                         ///< M
  double horizontal_aperture_rad = 0.0;  ///< alpha
  double vertical_aperture_rad = 0.0;    ///< beta

  /// The paper's sensor: 64 x 30, alpha = 60 degrees, beta = atan((M/N) tan alpha) = 39.07 degrees.
  static TiltedLineScan paper();
  /// Any raster with the paper's relation between the two apertures: beta = atan((M/N) tan alpha).
  /// @throws std::invalid_argument unless columns, rows >= 2 and 0 < alpha < 90 degrees
  static TiltedLineScan with_aperture(int columns, int rows, double horizontal_aperture_rad);
};

/// Range limits of the sensor.
struct RangeLimits {
  double min_m = 0.05;  ///< a nearer surface gives an invalid range (NaN)
  double max_m = 30.0;  ///< a farther surface gives no return (+inf)
};

/// The rays of a tilted line scan sensor (eq. 5): alpha_u = alpha (1/2 - u/(N-1)),
/// beta_v = beta (1/2 - v/(M-1)).
/// @throws std::invalid_argument unless columns, rows >= 2 and both apertures are in (0, pi)
RayTable make_ray_table(const TiltedLineScan& sensor);

}  // namespace nextview
