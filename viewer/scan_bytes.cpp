#include "viewer/scan_bytes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "viewer/surface_blocks.h"

namespace nextview {
namespace {

constexpr std::int16_t kNoReturn = 32767;
constexpr double kLargestUnits = 32000.0;

/// A pixel of the picture in the image: for upright lines a row of the image is a column of the
/// picture, from the left, and its columns are rows of the picture.
struct Pixel {
  int u, v;
};
Pixel pixel_of_picture(SensorKind kind, int column, int row) {
  return has_upright_lines(kind) ? Pixel{row, column} : Pixel{column, row};
}

float farthest_point(const RangeImage& image, const RangeBounds& bounds) {
  float farthest_m = 1.0F;
  for (const float range_m : image.range_m) {
    if (bounds.kind_of(range_m) == RangeKind::Point) farthest_m = std::max(farthest_m, range_m);
  }
  return farthest_m;
}

}  // namespace

std::vector<std::uint8_t> scan_bytes(const RangeImage& image) {
  const RangeBounds bounds(image.limits);
  const bool upright = has_upright_lines(image.rays.kind);
  const int all_columns = upright ? image.rays.rows() : image.rays.columns();
  const int all_rows = upright ? image.rays.columns() : image.rays.rows();
  const int columns = std::min(all_columns, kScanColumns);
  const int rows = std::min(all_rows, kScanRows);
  const double unit_m = static_cast<double>(farthest_point(image, bounds)) / kLargestUnits;

  std::vector<std::uint8_t> bytes;
  append_number(bytes, static_cast<std::uint16_t>(columns));
  append_number(bytes, static_cast<std::uint16_t>(rows));
  append_number(bytes, static_cast<float>(unit_m));
  const auto append_vector = [&bytes](const Eigen::Vector3d& vector) {
    for (int axis = 0; axis < 3; ++axis) append_number(bytes, static_cast<float>(vector[axis]));
  };
  const auto world_ray = [&](const Pixel& pixel) {
    return Eigen::Vector3d(image.world_from_sensor * image.rays.ray(pixel.u, pixel.v));
  };
  append_vector(image.position_m);
  for (const int row : {0, all_rows - 1}) {
    for (const int column : {0, all_columns - 1}) {
      append_vector(world_ray(pixel_of_picture(image.rays.kind, column, row)));
    }
  }
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Pixel pixel =
          pixel_of_picture(image.rays.kind, column * all_columns / columns, row * all_rows / rows);
      const float range_m =
          image.range_m[static_cast<std::size_t>(pixel.v * image.rays.columns() + pixel.u)];
      std::array<std::int16_t, 3> point = {0, 0, 0};
      const RangeKind kind = bounds.kind_of(range_m);
      if (kind == RangeKind::NoReturn) point.fill(kNoReturn);
      if (kind == RangeKind::Point) {
        const Eigen::Vector3d units = world_ray(pixel) * (static_cast<double>(range_m) / unit_m);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          point[axis] = static_cast<std::int16_t>(std::lround(units[static_cast<int>(axis)]));
        }
      }
      for (const std::int16_t value : point) append_number(bytes, value);
    }
  }
  return bytes;
}

}  // namespace nextview
