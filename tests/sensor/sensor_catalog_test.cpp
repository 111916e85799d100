#include "sensor/sensor_catalog.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/sensor/pixel_rays.h"

namespace nextview {
namespace {

namespace fs = std::filesystem;

const fs::path kCatalogue = fs::path(NEXTVIEW_SOURCE_DIR) / "sensor/catalogue";

// A file of one test, removed with it.
class SensorFileOf {
 public:
  explicit SensorFileOf(const std::string& text)
      : path_(fs::path(testing::TempDir()) /
              (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) +
               ".json")) {
    std::ofstream(path_) << text;
  }
  ~SensorFileOf() { fs::remove(path_); }
  std::string path() const { return path_.string(); }

 private:
  fs::path path_;
};

// What is said when it cannot be.
std::string refusal_of(const std::string& text, const SensorOptions& given = {}) {
  const SensorFileOf file(text);
  try {
    find_sensor(file.path(), kCatalogue, given);
  } catch (const SensorError& error) {
    const std::string what = error.what();
    EXPECT_TRUE(what.starts_with(file.path())) << what;
    return what.substr(std::min(what.size(), file.path().size()));
  }
  ADD_FAILURE() << "not refused: " << text;
  return {};
}

TEST(SensorCatalog, EveryNameIsASensor) {
  const std::vector<std::string> names = known_sensors(kCatalogue);
  for (const char* name : {"line_striper", "panorama", "paper"}) {
    EXPECT_NE(std::ranges::find(names, name), names.end()) << name;
  }
  for (const std::string& name : names) EXPECT_NO_THROW(find_sensor(name, kCatalogue, {})) << name;
}

TEST(SensorCatalog, ThePapersIsThePapers) {
  const SensorModel sensor = find_sensor("paper", kCatalogue, {});
  EXPECT_EQ(parameters_of(sensor.geometry), parameters_of(TiltedLineScan::paper()));
  EXPECT_EQ(columns_of(sensor.geometry), 64);
  EXPECT_EQ(rows_of(sensor.geometry), 30);
  EXPECT_EQ(sensor.limits.max_m, 30.0);
}

TEST(SensorCatalog, ThePanoramaHas250000PointsAllAroundAndNoPoles) {
  const SensorModel sensor = find_sensor("panorama", kCatalogue, {});
  const auto& panorama = std::get<SphericalScanner>(sensor.geometry);
  EXPECT_EQ(panorama.columns * panorama.rows, 250'000);
  EXPECT_NEAR(panorama.horizontal_aperture_rad, 360.0 * kDegree, 1e-12);
  EXPECT_NEAR(panorama.vertical_aperture_rad, 100.0 * kDegree, 1e-12);
}

TEST(SensorCatalog, ReadsAFile) {
  const SensorFileOf file(R"({"geometry": "line_striper", "columns": 20, "rows": 10,
      "sweep_deg": 50, "vertical_aperture_deg": 30, "baseline_m": 0.3,
      "range_min_m": 0.2, "range_max_m": 4, "range_noise_m": 0.01, "scan_duration_s": 2})");
  const SensorModel sensor = find_sensor(file.path(), kCatalogue, {});
  const auto& striper = std::get<LineStriper>(sensor.geometry);
  EXPECT_EQ(striper.columns, 20);
  EXPECT_EQ(striper.rows, 10);
  EXPECT_NEAR(striper.sweep_rad, 50.0 * kDegree, 1e-12);
  EXPECT_NEAR(striper.vertical_aperture_rad, 30.0 * kDegree, 1e-12);
  EXPECT_EQ(striper.baseline_m, 0.3);
  EXPECT_EQ(sensor.limits.min_m, 0.2);
  EXPECT_EQ(sensor.limits.max_m, 4.0);
  EXPECT_EQ(sensor.range_noise_m, 0.01);
  EXPECT_EQ(sensor.scan_duration_s, 2.0);
}

TEST(SensorCatalog, WhatIsGivenGoesBeforeTheFile) {
  SensorOptions given;
  given.columns = 400;
  given.rows = 200;
  given.aperture_rad = 45.0 * kDegree;
  given.range_max_m = 7.0;
  const SensorModel sensor = find_sensor("paper", kCatalogue, given);
  EXPECT_EQ(parameters_of(sensor.geometry),
            parameters_of(TiltedLineScan::with_aperture(400, 200, 45.0 * kDegree)));
  EXPECT_EQ(sensor.limits.max_m, 7.0);
  EXPECT_EQ(sensor.limits.min_m, RangeLimits().min_m);
}

TEST(SensorCatalog, SaysWhatIsWrongWithAFile) {
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  has(refusal_of("{"), "parse error");
  has(refusal_of("[]"), "must be a JSON object");
  has(refusal_of("{}"), "lacks \"geometry\"");
  has(refusal_of(R"({"geometry": "sonar", "columns": 9, "rows": 9})"), "'sonar' is none of");
  const std::string spherical = R"({"geometry": "spherical", "columns": 9, "rows": 9,
      "horizontal_aperture_deg": 360, "vertical_aperture_deg": )";
  has(refusal_of(spherical + "180}"), "180");
  has(refusal_of(spherical + "\"wide\"}"), "vertical_aperture_deg");
  has(refusal_of(spherical + "90, \"baseline_m\": 1}"), "\"baseline_m\" says nothing");
  has(refusal_of(R"({"geometry": "spherical", "columns": 9.5, "rows": 9})"), "whole number");
  SensorOptions given;
  given.aperture_rad = 100.0 * kDegree;
  has(refusal_of(R"({"geometry": "tilted_line_scan", "columns": 9, "rows": 9,
      "horizontal_aperture_deg": 60})",
                 given),
      "of 100 degrees is not from");
  has(refusal_of(R"({"geometry": "tilted_line_scan", "columns": 9, "rows": 9,
      "horizontal_aperture_deg": 60, "range_max_m": 1e6})"),
      "range_max_m = 1e+06 is not a number from");
}

TEST(SensorCatalog, SaysWhichNamesThereAre) {
  try {
    find_sensor("papre", kCatalogue, {});
    FAIL();
  } catch (const SensorError& error) {
    EXPECT_NE(std::string(error.what()).find("line_striper, panorama, paper"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace nextview
