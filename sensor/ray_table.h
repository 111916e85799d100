#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace nextview {

/// How pixels become rays (paper eq. 1 and 5), for every sensor and for all who ask: this header
/// alone knows.
///
/// An image is rows of pixels, and a row is a line scan: its rays lie in a plane through the
/// optical centre, fanned about it by an angle a of the column, and the planes of the rows are
/// turned about one axis by an angle b of the row. In the *line frame*, where that axis is x,
///
///     n(a, b) = R_axis(a) Rx(b) y = -sin a x + cos a ahead(b),    ahead(b) = cos b y + sin b z.
///
/// For a tilted line scan (eq. 5) the line frame is the sensor's. A sensor whose lines stand
/// upright and are turned about the sensor's z, as a spherical scanner's and a line striper's, is
/// the same with rows and columns exchanged and the frame turned: a row of the
/// table is then a column of its picture. So whoever works on rows of pixels needs no other
/// formula.
///
/// All rays start at one point, the optical centre. A sensor whose rays do not share an origin does
/// not fit: in the map update the voxel line from the sensor depends on nothing but the voxel it
/// ends in, so pixels share it; normals rest on inverse ranges being linear in the ray; and a view
/// is predicted from one voxel. Origins that lie within a small part of a voxel may count as one
/// (P11 has voxels larger than the errors of the points). A sensor that moves while it scans fits
/// as one image for each place it stands at, each from its own position.

/// The sensors there are (P5), each in a header of its own. Numbered as in messages.
enum class SensorKind : std::int8_t { TiltedLineScan = 0, Spherical = 1, LineStriper = 2 };
constexpr int kSensorKinds = 3;

/// Whether the lines of a sensor stand upright, along its z axis, and are turned about it; or else
/// lie along its x axis.
constexpr bool has_upright_lines(SensorKind kind) { return kind != SensorKind::TiltedLineScan; }

/// The line frame seen from the sensor's: its x, y and z in columns.
inline Eigen::Matrix3d sensor_from_lines(SensorKind kind) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (has_upright_lines(kind)) turn << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  return turn;
}

/// The rays of a row in a frame that somebody cares for:
/// ray(u) = cos(a_u) ahead - sin(a_u) axis.
struct RayRow {
  Eigen::Vector3d axis;
  Eigen::Vector3d ahead;

  /// The rays along one coordinate, for loops over columns.
  struct Along {
    double axis, ahead;
    double ray(double column_sin, double column_cos) const {
      return column_cos * ahead - column_sin * axis;
    }
  };
  Along along(int coordinate) const { return {axis[coordinate], ahead[coordinate]}; }
  Eigen::Vector3d ray(double column_sin, double column_cos) const {
    return {along(0).ray(column_sin, column_cos), along(1).ray(column_sin, column_cos),
            along(2).ray(column_sin, column_cos)};
  }
};

/// The orthonormal frame of a ray: n itself; n_a = dn/da, along its row; e_b = (dn/db) / cos a,
/// across it.
template <class Real>
struct RayFrame {
  Real sin_a, cos_a, sin_b, cos_b;

  struct InLineFrame {
    Real x, y, z;
  };
  /// r n + s n_a + t e_b.
  InLineFrame vector(Real r, Real s, Real t) const {
    const Real ahead = cos_a * r - sin_a * s;
    return {-(sin_a * r) - cos_a * s, ahead * cos_b - t * sin_b, ahead * sin_b + t * cos_b};
  }
};

/// The rays of all pixels, as the sines and cosines of their angles. The table and not the
/// apertures travels with a range image, because libm differs between machines.
///
/// Pixel (u, v) is place u of the row v; its index in a range image is v * columns() + u.
struct RayTable {
  std::vector<double> column_sin;  ///< sin(a_u), size N
  std::vector<double> column_cos;  ///< cos(a_u), size N
  std::vector<double> row_sin;     ///< sin(b_v), size M
  std::vector<double> row_cos;     ///< cos(b_v), size M
  SensorKind kind = SensorKind::TiltedLineScan;

  int columns() const { return static_cast<int>(column_sin.size()); }
  int rows() const { return static_cast<int>(row_sin.size()); }
  std::size_t pixels() const { return column_sin.size() * row_sin.size(); }

  /// n_uv, a unit vector of the sensor frame.
  Eigen::Vector3d ray(int u, int v) const {
    const auto column = static_cast<std::size_t>(u);
    const auto row = static_cast<std::size_t>(v);
    const Eigen::Vector3d n(-column_sin[column], column_cos[column] * row_cos[row],
                            column_cos[column] * row_sin[row]);
    return has_upright_lines(kind) ? Eigen::Vector3d(-n.z(), n.y(), n.x()) : n;
  }

  /// The frame of row(), to be worked out once for all rows.
  Eigen::Matrix3d world_from_lines(const Eigen::Matrix3d& world_from_sensor) const {
    if (!has_upright_lines(kind)) return world_from_sensor;
    return world_from_sensor * sensor_from_lines(kind);
  }
  /// The rays of row v in the world: R n_uv of eq. 1.
  RayRow row(int v, const Eigen::Matrix3d& world_from_lines) const {
    const double sin_b = row_sin[static_cast<std::size_t>(v)];
    const double cos_b = row_cos[static_cast<std::size_t>(v)];
    return {world_from_lines.col(0),
            cos_b * world_from_lines.col(1) + sin_b * world_from_lines.col(2)};
  }
};

}  // namespace nextview
