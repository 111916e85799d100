#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "sensor/range_image.h"
#include "sensor/range_picture.h"

/// What a robot and its sensor have left in a folder; docs/own-sensor.md says what the files hold.
struct RecordedArrival {
  std::int64_t utime = 0;
  bool arrived = false;
  nextview::SensorPose pose;
  double path_length_m = 0.0;
  std::string refusal;
};

class RecordedFiles {
 public:
  using ViewAndAttempt = std::pair<int, int>;

  /// Reads arrivals.csv, scans.csv, sensor.csv and rays.csv.
  /// @throws std::runtime_error naming the file and the line that cannot be read
  explicit RecordedFiles(const std::filesystem::path& folder);

  /// nullptr where there is none.
  const RecordedArrival* arrival(int view, int attempt) const;
  /// The image taken after an arrival, and when.
  /// @throws std::runtime_error naming the file that cannot be read, std::out_of_range when there
  /// is
  ///         no such scan
  std::pair<nextview::RangeImage, std::int64_t> scan(int view, int attempt) const;

 private:
  void read_sensor();
  void read_arrivals();
  void read_scans();

  struct Scan {
    std::int64_t utime = 0;
    nextview::SensorPose pose;
    Eigen::Matrix3d world_from_sensor;
    std::string file;  // of the ranges
  };
  std::filesystem::path folder_;
  nextview::PictureRays rays_;
  nextview::RangeLimits limits_;
  std::map<ViewAndAttempt, RecordedArrival> arrivals_;
  std::map<ViewAndAttempt, Scan> scans_;
};
