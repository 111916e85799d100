#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

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

/// The directions of all pixels, as the sines and cosines the geometry is made of. The table and
/// not the apertures travels with a range image, because libm differs between machines.
///
/// Pixel (u, v) is column u of N from the left and row v of M from the top; its index in a range
/// image is v * N + u.
///
/// All rays start at one point, the optical centre. The map update rests on it: the voxel line from
/// the sensor depends on nothing but the voxel it ends in, so pixels share it. A sensor whose rays
/// do not share an origin does not fit.
struct RayTable {
  std::vector<double> column_sin;  ///< sin(alpha_u), size N
  std::vector<double> column_cos;  ///< cos(alpha_u), size N
  std::vector<double> row_sin;     ///< sin(beta_v), size M
  std::vector<double> row_cos;     ///< cos(beta_v), size M

  int columns() const { return static_cast<int>(column_sin.size()); }
  int rows() const { return static_cast<int>(row_sin.size()); }
  std::size_t pixels() const { return column_sin.size() * row_sin.size(); }

  /// n_uv of eq. 5, a unit vector of the sensor frame:
  /// R_a(alpha_u) Rx(beta_v) y = Rx(beta_v) Rz(alpha_u) y.
  Eigen::Vector3d ray(int u, int v) const {
    const auto column = static_cast<std::size_t>(u);
    const auto row = static_cast<std::size_t>(v);
    return {-column_sin[column], column_cos[column] * row_cos[row],
            column_cos[column] * row_sin[row]};
  }
};

/// The rays of a tilted line scan sensor (eq. 5): alpha_u = alpha (1/2 - u/(N-1)),
/// beta_v = beta (1/2 - v/(M-1)).
/// @throws std::invalid_argument unless columns, rows >= 2 and both apertures are in (0, pi)
RayTable make_ray_table(const TiltedLineScan& sensor);

}  // namespace nextview
