#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "sensor/sensor_geometry.h"

namespace nextview {

/// A sensor that is not there, or whose file cannot be right. The message says which file and what
/// to do.
class SensorError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a user may say of a sensor in place of its file.
struct SensorOptions {
  std::optional<int> columns, rows;
  /// Horizontal; a tilted line scan's vertical one then follows from it as the paper's does.
  std::optional<double> aperture_rad;
  std::optional<double> range_min_m, range_max_m, range_noise_m, scan_duration_s;
};

/// Finds a sensor by name, NAME.json in the catalogue, or by the path of such a file. A file is a
/// JSON object:
///
///     { "geometry": "spherical",            or "tilted_line_scan", "line_striper"
///       "columns": 1000, "rows": 250,       of its picture
///       "horizontal_aperture_deg": 360,     tilted_line_scan and spherical
///       "sweep_deg": 60,                    line_striper
///       "vertical_aperture_deg": 100,       a tilted_line_scan's may be left out: the paper's
///       "baseline_m": 0.1,                  line_striper
///       "range_min_m": 0.05, "range_max_m": 30, "range_noise_m": 0, "scan_duration_s": 1 }
///
/// The last four may be left out, and are then those of SensorModel; so may the baseline.
/// @throws SensorError, also when the sensor that results cannot be
SensorModel find_sensor(const std::string& name_or_file, const std::filesystem::path& catalogue,
                        const SensorOptions& given);

/// The names in a catalogue, in order.
std::vector<std::string> known_sensors(const std::filesystem::path& catalogue);

}  // namespace nextview
