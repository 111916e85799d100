#include "sensor/sensor_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <stdexcept>

#include "lcmtypes/parameter_bounds.h"
#include "sensor/elementary_functions.h"

namespace nextview {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

void check_raster(int columns, int rows) {
  bounds::kColumns.require(columns);
  bounds::kRows.require(rows);
}

void check_aperture(const char* name, double angle_rad, const Bounds& bounds) {
  if (bounds.contain(angle_rad)) return;
  const double degrees = angle_rad * 360.0 / kTurn;
  throw std::invalid_argument(fmt::format("a sensor's {} of {:.7g} degrees is not {}", name,
                                          degrees, bounds.in_degrees().range()));
}

void check(const TiltedLineScan& sensor) {
  check_raster(sensor.columns, sensor.rows);
  check_aperture("horizontal aperture", sensor.horizontal_aperture_rad, bounds::kAperture);
  check_aperture("vertical aperture", sensor.vertical_aperture_rad, bounds::kAperture);
}
void check(const SphericalScanner& sensor) {
  check_raster(sensor.columns, sensor.rows);
  check_aperture("horizontal aperture", sensor.horizontal_aperture_rad, bounds::kTurnAperture);
  check_aperture("vertical aperture", sensor.vertical_aperture_rad, bounds::kAperture);
}
void check(const LineStriper& sensor) {
  check_raster(sensor.columns, sensor.rows);
  check_aperture("sweep", sensor.sweep_rad, bounds::kAperture);
  check_aperture("vertical aperture", sensor.vertical_aperture_rad, bounds::kAperture);
  bounds::kBaseline.require(sensor.baseline_m);
}

// The angles of an axis, as its sines and cosines.
struct Axis {
  void add(double angle) {
    sines.push_back(elementary::sin(angle));
    cosines.push_back(elementary::cos(angle));
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
  check_aperture("horizontal aperture from which its vertical one follows", horizontal_aperture_rad,
                 bounds::kTiltedAperture);
  TiltedLineScan sensor;
  sensor.columns = columns;
  sensor.rows = rows;
  sensor.horizontal_aperture_rad = horizontal_aperture_rad;
  sensor.vertical_aperture_rad = elementary::atan(static_cast<double>(rows) / columns *
                                                  elementary::tan(horizontal_aperture_rad));
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
  const double spacing =
      std::min(sensor.horizontal_aperture_rad / (sensor.columns - 1), kTurn / sensor.columns);
  Axis phi;
  for (int u = 0; u < sensor.columns; ++u) phi.add(spacing * (0.5 * (sensor.columns - 1) - u));
  return upright(SensorKind::Spherical, phi,
                 even_angles(sensor.rows, sensor.vertical_aperture_rad));
}

RayTable make_ray_table(const LineStriper& sensor) {
  check(sensor);
  const double highest = elementary::tan(0.5 * sensor.vertical_aperture_rad);
  Axis theta;
  for (int v = 0; v < sensor.rows; ++v) {
    theta.add(elementary::atan(highest * (1.0 - 2.0 * v / (sensor.rows - 1))));
  }
  return upright(SensorKind::LineStriper, even_angles(sensor.columns, sensor.sweep_rad), theta);
}

void check_sensor(const SensorGeometry& sensor) {
  std::visit([](const auto& of) { check(of); }, sensor);
}

void check_sensor(const SensorModel& sensor) {
  check_sensor(sensor.geometry);
  bounds::kRangeMin.require(sensor.limits.min_m);
  bounds::kRangeMax.require(sensor.limits.max_m);
  require_below("range_min_m", sensor.limits.min_m, "range_max_m", sensor.limits.max_m);
  bounds::kRangeNoise.require(sensor.range_noise_m);
  bounds::kScanDuration.require(sensor.scan_duration_s);
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
  throw std::invalid_argument(fmt::format("there is no sensor of kind {}", static_cast<int>(kind)));
}

double baseline_m_of(const SensorGeometry& sensor) {
  const auto* const striper = std::get_if<LineStriper>(&sensor);
  return striper == nullptr ? 0.0 : striper->baseline_m;
}

RayTable make_ray_table(const SensorGeometry& sensor) {
  return std::visit([](const auto& of) { return make_ray_table(of); }, sensor);
}

}  // namespace nextview
