#include "recorded_files.h"

#include <bit>
#include <fstream>
#include <functional>
#include <sstream>
#include <stdexcept>

namespace {

static_assert(std::endian::native == std::endian::little, "ranges are little-endian in the files");

/// The cells of a line; what comes after the last cell wanted stays in it, commas and all.
class Cells {
 public:
  explicit Cells(const std::string& line) : line_(line) {}
  std::string text() {
    std::string cell;
    if (!std::getline(line_, cell, ',')) throw std::runtime_error("too few cells");
    return cell;
  }
  std::string rest() {
    std::string cell;
    std::getline(line_, cell);
    return cell;
  }
  double number() { return std::stod(text()); }
  int integer() { return std::stoi(text()); }
  std::int64_t long_integer() { return std::stoll(text()); }

 private:
  std::istringstream line_;
};

/// Calls take(cells) for every line but the first, which holds the headings.
void for_each_line(const std::filesystem::path& file, const std::function<void(Cells&)>& take) {
  std::ifstream stream(file);
  std::string line;
  if (!std::getline(stream, line)) throw std::runtime_error(file.string() + ": cannot be read");
  for (int number = 2; std::getline(stream, line); ++number) {
    try {
      Cells cells(line);
      take(cells);
    } catch (const std::exception& error) {
      throw std::runtime_error(file.string() + ":" + std::to_string(number) +
                               ": does not hold what its headings say: " + error.what());
    }
  }
}

nextview::SensorPose pose_in(Cells& cells) {
  nextview::SensorPose pose;
  for (int axis = 0; axis < 3; ++axis) pose.position_m[axis] = cells.number();
  pose.pan_rad = cells.number();
  pose.tilt_rad = cells.number();
  return pose;
}

RecordedFiles::ViewAndAttempt key_in(Cells& cells) {
  const int view = cells.integer();
  return {view, cells.integer()};
}

}  // namespace

RecordedFiles::RecordedFiles(const std::filesystem::path& folder) : folder_(folder) {
  read_sensor();
  read_arrivals();
  read_scans();
}

void RecordedFiles::read_sensor() {
  std::size_t columns = 0;
  std::size_t rows = 0;
  for_each_line(folder_ / "sensor.csv", [&](Cells& cells) {
    rays_.kind = static_cast<nextview::SensorKind>(cells.integer());
    columns = static_cast<std::size_t>(cells.integer());
    rows = static_cast<std::size_t>(cells.integer());
    limits_.min_m = cells.number();
    limits_.max_m = cells.number();
  });
  for_each_line(folder_ / "rays.csv", [&](Cells& cells) {
    const bool is_column = rays_.column_sin.size() < columns;
    (is_column ? rays_.column_sin : rays_.row_sin).push_back(cells.number());
    (is_column ? rays_.column_cos : rays_.row_cos).push_back(cells.number());
  });
  if (rays_.row_sin.size() != rows) {
    throw std::runtime_error((folder_ / "rays.csv").string() +
                             ": not a line for every column and row that sensor.csv says");
  }
}

void RecordedFiles::read_arrivals() {
  for_each_line(folder_ / "arrivals.csv", [this](Cells& cells) {
    RecordedArrival& arrival = arrivals_[key_in(cells)];
    arrival.utime = cells.long_integer();
    arrival.arrived = cells.integer() != 0;
    arrival.pose = pose_in(cells);
    arrival.path_length_m = cells.number();
    arrival.refusal = cells.rest();
  });
}

void RecordedFiles::read_scans() {
  for_each_line(folder_ / "scans.csv", [this](Cells& cells) {
    Scan& scan = scans_[key_in(cells)];
    scan.utime = cells.long_integer();
    scan.pose = pose_in(cells);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column)
        scan.world_from_sensor(row, column) = cells.number();
    }
    scan.file = cells.rest();
  });
}

const RecordedArrival* RecordedFiles::arrival(int view, int attempt) const {
  const auto found = arrivals_.find({view, attempt});
  return found == arrivals_.end() ? nullptr : &found->second;
}

std::pair<nextview::RangeImage, std::int64_t> RecordedFiles::scan(int view, int attempt) const {
  const Scan& scan = scans_.at({view, attempt});
  nextview::RangeImage image;
  image.pose = scan.pose;
  image.position_m = scan.pose.position_m;
  image.world_from_sensor = scan.world_from_sensor;
  image.rays = nextview::table_of_picture(rays_);
  image.limits = limits_;
  image.range_m.resize(rays_.column_sin.size() * rays_.row_sin.size());
  const auto bytes = static_cast<std::streamsize>(image.range_m.size() * sizeof(float));
  std::ifstream stream(folder_ / scan.file, std::ios::binary);
  if (!stream.read(reinterpret_cast<char*>(image.range_m.data()), bytes)) {
    throw std::runtime_error((folder_ / scan.file).string() + ": does not hold " +
                             std::to_string(image.range_m.size()) + " floats");
  }
  // A sensor whose lines stand upright keeps its image turned, see sensor/ray_table.h.
  if (nextview::has_upright_lines(rays_.kind)) {
    image.range_m = nextview::transposed(image.range_m, rays_.column_sin.size());
  }
  return {image, scan.utime};
}
