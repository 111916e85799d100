#pragma once

#include <array>
#include <variant>

#include "sensor/line_striper.h"
#include "sensor/spherical_scanner.h"
#include "sensor/tilted_line_scan.h"

namespace nextview {

/// Any of the sensors (P5), by SensorKind. make_ray_table gives the rays of each: see its header.
using SensorGeometry = std::variant<TiltedLineScan, SphericalScanner, LineStriper>;

/// The same sensor with other numbers of pixels over the same apertures.
SensorGeometry with_raster(SensorGeometry sensor, int columns, int rows);
/// Whether there can be such a sensor, without making its rays.
/// @throws std::invalid_argument saying why not, as make_ray_table does
void check_sensor(const SensorGeometry& sensor);
int columns_of(const SensorGeometry& sensor);  ///< of its picture
int rows_of(const SensorGeometry& sensor);

SensorKind kind_of(const SensorGeometry& sensor);

/// What each sensor has besides its raster, angles in radians and lengths in metres, in the order
/// of its struct; 0 beyond. As messages carry it.
using SensorParameters = std::array<double, 8>;
SensorParameters parameters_of(const SensorGeometry& sensor);
/// The sensor that has these. Whether there can be such a sensor, make_ray_table says.
/// @throws std::invalid_argument unless what is beyond a kind's parameters is 0
SensorGeometry make_sensor(SensorKind kind, int columns, int rows,
                           const SensorParameters& parameters);

/// How far the camera of a line striper stands from its light; 0 for all others.
double baseline_m_of(const SensorGeometry& sensor);

/// @throws std::invalid_argument as the overload for the sensor does
RayTable make_ray_table(const SensorGeometry& sensor);

/// Range limits of the sensor.
struct RangeLimits {
  double min_m = 0.05;  ///< a nearer surface gives an invalid range (NaN)
  double max_m = 30.0;  ///< a farther surface gives no return (+inf)
};

/// A sensor as a run has it.
struct SensorModel {
  SensorGeometry geometry = TiltedLineScan::paper();
  RangeLimits limits;
  double range_noise_m = 0.0;    ///< standard deviation of Gaussian range noise
  double scan_duration_s = 1.0;  ///< simulated time one scan takes
};

/// Whether there can be such a sensor.
/// @throws std::invalid_argument naming the parameter that cannot be
void check_sensor(const SensorModel& sensor);

}  // namespace nextview
