#include "sensor/sensor_geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "lcmtypes/parameter_bounds.h"

namespace nextview {

namespace {

constexpr double kHalfTurn = std::numbers::pi;

void check_raster(int columns, int rows) {
  bounds::kColumns.require(columns);
  bounds::kRows.require(rows);
}

// An aperture ends below its limit, or with it where that is a whole turn.
void check_aperture(const char* name, double angle_rad, double most_rad) {
  const bool in_range =
      most_rad < 2.0 * kHalfTurn ? angle_rad < most_rad : angle_rad <= most_rad * (1.0 + 1e-12);
  if (angle_rad > 0.0 && in_range) return;
  throw std::invalid_argument(
      "a sensor's " + std::string(name) + " of " + std::to_string(angle_rad * 180.0 / kHalfTurn) +
      " degrees is not above 0 and below " + (most_rad < 2.0 * kHalfTurn ? "180" : "or at 360"));
}

void check(const TiltedLineScan& sensor) {
  check_raster(sensor.columns, sensor.rows);
  check_aperture("horizontal aperture", sensor.horizontal_aperture_rad, kHalfTurn);
  check_aperture("vertical aperture", sensor.vertical_aperture_rad, kHalfTurn);
}
void check(const SphericalScanner& sensor) {
  check_raster(sensor.columns, sensor.rows);
  check_aperture("horizontal aperture", sensor.horizontal_aperture_rad, 2.0 * kHalfTurn);
  check_aperture("vertical aperture", sensor.vertical_aperture_rad, kHalfTurn);
}
void check(const LineStriper& sensor) {
  check_raster(sensor.columns, sensor.rows);
  check_aperture("sweep", sensor.sweep_rad, kHalfTurn);
  check_aperture("vertical aperture", sensor.vertical_aperture_rad, kHalfTurn);
  bounds::kBaseline.require(sensor.baseline_m);
}

// The angles of an axis, as its sines and cosines.
struct Axis {
  void add(double angle) {
    sines.push_back(std::sin(angle));
    cosines.push_back(std::cos(angle));
  }
  std::vector<double> sines, cosines;
};

// From half an aperture to minus half of it, evenly.
Axis even_angles(int count, double aperture_rad) {
  Axis axis;
  for (int i = 0; i < count; ++i) {
    axis.add(aperture_rad * (0.5 - static_cast<double>(i) / (count - 1)));
  }
  return axis;
}

// The table of upright lines at angles phi, with angles theta along them.
RayTable upright(SensorKind kind, const Axis& phi, const Axis& theta) {
  RayTable table{theta.sines, theta.cosines, phi.sines, phi.cosines, kind};
  for (double& sine : table.column_sin) sine = -sine;  // a = -theta
  return table;
}

}  // namespace

TiltedLineScan TiltedLineScan::paper() { return with_aperture(64, 30, std::numbers::pi / 3.0); }

TiltedLineScan TiltedLineScan::with_aperture(int columns, int rows,
                                             double horizontal_aperture_rad) {
  check_raster(columns, rows);
  if (!(horizontal_aperture_rad > 0.0 && horizontal_aperture_rad < std::numbers::pi / 2.0)) {
    throw std::invalid_argument(
        "the horizontal aperture must lie between 0 and 90 degrees, both excluded");
  }
  TiltedLineScan sensor;
  sensor.columns = columns;
  sensor.rows = rows;
  sensor.horizontal_aperture_rad = horizontal_aperture_rad;
  sensor.vertical_aperture_rad =
      std::atan(static_cast<double>(rows) / columns * std::tan(horizontal_aperture_rad));
  return sensor;
}

RayTable make_ray_table(const TiltedLineScan& sensor) {
  check(sensor);
  const Axis alpha = even_angles(sensor.columns, sensor.horizontal_aperture_rad);
  const Axis beta = even_angles(sensor.rows, sensor.vertical_aperture_rad);
  return {alpha.sines, alpha.cosines, beta.sines, beta.cosines, SensorKind::TiltedLineScan};
}

RayTable make_ray_table(const SphericalScanner& sensor) {
  check(sensor);
  const double spacing = std::min(sensor.horizontal_aperture_rad / (sensor.columns - 1),
                                  2.0 * kHalfTurn / sensor.columns);
  Axis phi;
  for (int u = 0; u < sensor.columns; ++u) phi.add(spacing * (0.5 * (sensor.columns - 1) - u));
  return upright(SensorKind::Spherical, phi,
                 even_angles(sensor.rows, sensor.vertical_aperture_rad));
}

RayTable make_ray_table(const LineStriper& sensor) {
  check(sensor);
  const double highest = std::tan(0.5 * sensor.vertical_aperture_rad);
  Axis theta;
  for (int v = 0; v < sensor.rows; ++v) {
    theta.add(std::atan(highest * (1.0 - 2.0 * v / (sensor.rows - 1))));
  }
  return upright(SensorKind::LineStriper, even_angles(sensor.columns, sensor.sweep_rad), theta);
}

void check_sensor(const SensorGeometry& sensor) {
  std::visit([](const auto& of) { check(of); }, sensor);
}

SensorGeometry with_raster(SensorGeometry sensor, int columns, int rows) {
  std::visit(
      [&](auto& of) {
        of.columns = columns;
        of.rows = rows;
      },
      sensor);
  return sensor;
}

int columns_of(const SensorGeometry& sensor) {
  return std::visit([](const auto& of) { return of.columns; }, sensor);
}
int rows_of(const SensorGeometry& sensor) {
  return std::visit([](const auto& of) { return of.rows; }, sensor);
}

SensorKind kind_of(const SensorGeometry& sensor) { return static_cast<SensorKind>(sensor.index()); }

SensorParameters parameters_of(const SensorGeometry& sensor) {
  struct Parameters {
    SensorParameters operator()(const TiltedLineScan& of) const {
      return {of.horizontal_aperture_rad, of.vertical_aperture_rad};
    }
    SensorParameters operator()(const SphericalScanner& of) const {
      return {of.horizontal_aperture_rad, of.vertical_aperture_rad};
    }
    SensorParameters operator()(const LineStriper& of) const {
      return {of.sweep_rad, of.vertical_aperture_rad, of.baseline_m};
    }
  };
  return std::visit(Parameters{}, sensor);
}

SensorGeometry make_sensor(SensorKind kind, int columns, int rows,
                           const SensorParameters& parameters) {
  const std::size_t used = kind == SensorKind::LineStriper ? 3 : 2;
  for (std::size_t i = used; i < parameters.size(); ++i) {
    if (parameters[i] == 0.0) continue;
    throw std::invalid_argument("a parameter the sensor has no use for");
  }
  switch (kind) {
    case SensorKind::TiltedLineScan:
      return TiltedLineScan{columns, rows, parameters[0], parameters[1]};
    case SensorKind::Spherical:
      return SphericalScanner{columns, rows, parameters[0], parameters[1]};
    case SensorKind::LineStriper:
      return LineStriper{columns, rows, parameters[0], parameters[1], parameters[2]};
  }
  throw std::invalid_argument("there is no sensor of kind " +
                              std::to_string(static_cast<int>(kind)));
}

double baseline_m_of(const SensorGeometry& sensor) {
  const auto* const striper = std::get_if<LineStriper>(&sensor);
  return striper == nullptr ? 0.0 : striper->baseline_m;
}

RayTable make_ray_table(const SensorGeometry& sensor) {
  return std::visit([](const auto& of) { return make_ray_table(of); }, sensor);
}

}  // namespace nextview
