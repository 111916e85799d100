#pragma once

#include <cstdint>
#include <vector>

#include "sensor/range_image.h"

namespace nextview {

/// A larger image is thinned out for the page to at most so many pixels a side.
constexpr int kScanColumns = 256;
constexpr int kScanRows = 128;

/// A range image for the page, as its picture (range_picture.h): columns from the left, rows from
/// the top.
///   u16     columns, rows
///   f32     metres a unit of the points; x, y, z of the optical centre, world frame
///   f32 x 3 directions of the picture's corner rays, world frame: top left, top right, bottom
///   left,
///           bottom right
///   per pixel i16 x 3, its point relative to the optical centre, world frame, in units; no point
///   is
///           ever zero or begins with 32767, so all zero stands for invalid, 32767 for no return
std::vector<std::uint8_t> scan_bytes(const RangeImage& image);

}  // namespace nextview
