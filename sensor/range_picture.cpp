#include "sensor/range_picture.h"

#include <cstddef>
#include <utility>

namespace nextview {

namespace {

std::vector<double> negative(std::vector<double> values) {
  for (double& value : values) value = -value;
  return values;
}

}  // namespace

PictureRays picture_rays(const RayTable& rays) {
  if (!has_upright_lines(rays.kind)) {
    return {rays.kind, rays.column_sin, rays.column_cos, rays.row_sin, rays.row_cos};
  }
  return {rays.kind, rays.row_sin, rays.row_cos, negative(rays.column_sin), rays.column_cos};
}

RayTable table_of_picture(PictureRays picture) {
  if (!has_upright_lines(picture.kind)) {
    return {std::move(picture.column_sin), std::move(picture.column_cos),
            std::move(picture.row_sin), std::move(picture.row_cos), picture.kind};
  }
  return {negative(std::move(picture.row_sin)), std::move(picture.row_cos),
          std::move(picture.column_sin), std::move(picture.column_cos), picture.kind};
}

std::vector<float> transposed(std::span<const float> range_m, std::size_t columns) {
  std::vector<float> result(range_m.size());
  const std::size_t rows = columns == 0 ? 0 : range_m.size() / columns;
  for (std::size_t v = 0; v < rows; ++v) {
    for (std::size_t u = 0; u < columns; ++u) result[u * rows + v] = range_m[v * columns + u];
  }
  return result;
}

}  // namespace nextview
