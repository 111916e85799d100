#include "sensor/sensor_catalog.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <type_traits>

namespace nextview {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

// One file. Remembers what has been asked for: what nothing reads is a mistake of whoever wrote it.
class SensorFile {
 public:
  explicit SensorFile(const fs::path& path) : path_(path) {
    std::ifstream stream(path);
    try {
      json_ = json::parse(stream);
    } catch (const json::exception& error) {
      fail(error.what());
    }
    if (!json_.is_object()) fail("must be a JSON object");
  }

  template <class Value>
  std::optional<Value> find(const std::string& key) {
    read_.insert(key);
    if (!json_.contains(key)) return std::nullopt;
    if (std::is_integral_v<Value> && !json_[key].is_number_integer()) {
      fail("\"" + key + "\" must be a whole number");
    }
    try {
      return json_[key].get<Value>();
    } catch (const json::exception& error) {
      fail("\"" + key + "\": " + error.what());
    }
  }
  template <class Value>
  Value get(const std::string& key) {
    const std::optional<Value> value = find<Value>(key);
    if (!value) fail("lacks \"" + key + "\"");
    return *value;
  }
  double radians(const std::string& key) { return get<double>(key) * std::numbers::pi / 180.0; }

  void refuse_what_was_not_read() const {
    for (const auto& [key, value] : json_.items()) {
      if (!read_.contains(key)) fail("\"" + key + "\" says nothing to a sensor of this geometry");
    }
  }
  [[noreturn]] void fail(const std::string& why) const {
    throw SensorError(path_.string() + ": " + why);
  }

 private:
  fs::path path_;
  json json_;
  std::set<std::string> read_;
};

TiltedLineScan tilted_line_scan(SensorFile& file, int columns, int rows,
                                const std::optional<double>& given_rad) {
  const double horizontal_rad = file.radians("horizontal_aperture_deg");
  const bool has_vertical = file.find<double>("vertical_aperture_deg").has_value();
  if (given_rad) return TiltedLineScan::with_aperture(columns, rows, *given_rad);
  if (!has_vertical) return TiltedLineScan::with_aperture(columns, rows, horizontal_rad);
  return {columns, rows, horizontal_rad, file.radians("vertical_aperture_deg")};
}

SensorGeometry geometry_of(SensorFile& file, const SensorOptions& given) {
  const auto name = file.get<std::string>("geometry");
  const int columns_in_file = file.get<int>("columns");
  const int rows_in_file = file.get<int>("rows");
  const int columns = given.columns.value_or(columns_in_file);
  const int rows = given.rows.value_or(rows_in_file);
  if (name == "tilted_line_scan") {
    return tilted_line_scan(file, columns, rows, given.aperture_rad);
  }
  if (name == "spherical") {
    const double horizontal_rad = file.radians("horizontal_aperture_deg");
    return SphericalScanner{columns, rows, given.aperture_rad.value_or(horizontal_rad),
                            file.radians("vertical_aperture_deg")};
  }
  if (name == "line_striper") {
    const double sweep_rad = file.radians("sweep_deg");
    return LineStriper{columns, rows, given.aperture_rad.value_or(sweep_rad),
                       file.radians("vertical_aperture_deg"),
                       file.find<double>("baseline_m").value_or(LineStriper{}.baseline_m)};
  }
  file.fail("\"geometry\": '" + name + "' is none of tilted_line_scan, spherical and line_striper");
}

fs::path file_of(const std::string& name_or_file, const fs::path& catalogue) {
  const std::vector<std::string> known = known_sensors(catalogue);
  if (std::find(known.begin(), known.end(), name_or_file) != known.end()) {
    return catalogue / (name_or_file + ".json");
  }
  if (fs::is_regular_file(name_or_file)) return name_or_file;
  std::string names;
  for (const std::string& name : known) names += (names.empty() ? "" : ", ") + name;
  throw SensorError(name_or_file + ": no such file, and no sensor of that name; the sensors in " +
                    catalogue.string() + " are: " + (names.empty() ? "none" : names));
}

}  // namespace

std::vector<std::string> known_sensors(const fs::path& catalogue) {
  std::vector<std::string> names;
  if (fs::is_directory(catalogue)) {
    for (const fs::directory_entry& entry : fs::directory_iterator(catalogue)) {
      if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

SensorModel find_sensor(const std::string& name_or_file, const fs::path& catalogue,
                        const SensorOptions& given) {
  SensorFile file(file_of(name_or_file, catalogue));
  SensorModel sensor;
  try {
    sensor.geometry = geometry_of(file, given);
    check_sensor(sensor.geometry);
  } catch (const std::invalid_argument& error) {
    file.fail(error.what());
  }
  const auto take = [&file](const std::optional<double>& option, const char* key, double& value) {
    const std::optional<double> in_file = file.find<double>(key);
    value = option ? *option : in_file.value_or(value);
  };
  take(given.range_min_m, "range_min_m", sensor.limits.min_m);
  take(given.range_max_m, "range_max_m", sensor.limits.max_m);
  take(given.range_noise_m, "range_noise_m", sensor.range_noise_m);
  take(given.scan_duration_s, "scan_duration_s", sensor.scan_duration_s);
  file.refuse_what_was_not_read();
  try {
    check_sensor(sensor);
  } catch (const std::invalid_argument& error) {
    file.fail(error.what());
  }
  return sensor;
}

}  // namespace nextview
