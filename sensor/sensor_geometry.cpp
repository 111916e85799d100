#include "sensor/sensor_geometry.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "lcmtypes/parameter_bounds.h"

namespace nextview {

TiltedLineScan TiltedLineScan::paper() { return with_aperture(64, 30, std::numbers::pi / 3.0); }

TiltedLineScan TiltedLineScan::with_aperture(int columns, int rows,
                                             double horizontal_aperture_rad) {
  bounds::kColumns.require(columns);
  bounds::kRows.require(rows);
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

namespace {

void fill_angles(int count, double aperture_rad, std::vector<double>& sines,
                 std::vector<double>& cosines) {
  for (int i = 0; i < count; ++i) {
    const double angle = aperture_rad * (0.5 - static_cast<double>(i) / (count - 1));
    sines.push_back(std::sin(angle));
    cosines.push_back(std::cos(angle));
  }
}

bool is_aperture(double angle_rad) { return angle_rad > 0.0 && angle_rad < std::numbers::pi; }

}  // namespace

RayTable make_ray_table(const TiltedLineScan& sensor) {
  bounds::kColumns.require(sensor.columns);
  bounds::kRows.require(sensor.rows);
  if (!is_aperture(sensor.horizontal_aperture_rad) || !is_aperture(sensor.vertical_aperture_rad)) {
    throw std::invalid_argument("a sensor's apertures must lie between 0 and 180 degrees");
  }
  RayTable table;
  fill_angles(sensor.columns, sensor.horizontal_aperture_rad, table.column_sin, table.column_cos);
  fill_angles(sensor.rows, sensor.vertical_aperture_rad, table.row_sin, table.row_cos);
  return table;
}

}  // namespace nextview
