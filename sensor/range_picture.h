#pragma once

#include <span>
#include <vector>

#include "sensor/ray_table.h"

namespace nextview {

/// The rays of a range image as people look at it and as it travels: columns from the left, rows
/// from the top, pixel (u, v) at v * columns + u. For a sensor whose lines stand upright a row of
/// the image is a column of the picture, and
///
///     n_uv = (-sin phi_u cos theta_v, cos phi_u cos theta_v, sin theta_v),
///
/// phi of the picture's columns, theta of its rows; for a tilted line scan picture and image are
/// the same (ray_table.h).
struct PictureRays {
  SensorKind kind = SensorKind::TiltedLineScan;
  std::vector<double> column_sin, column_cos;
  std::vector<double> row_sin, row_cos;
};

PictureRays picture_rays(const RayTable& rays);
RayTable table_of_picture(PictureRays picture);

/// The pixels of an image with upright lines as those of its picture, or the other way round: its
/// rows as columns.
std::vector<float> transposed(std::span<const float> range_m, std::size_t columns);

}  // namespace nextview
