#include "viewer/scan_bytes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "tests/viewer/page_model.h"

namespace nextview {
namespace {

Eigen::Vector3d vector_at(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  return {number_at<float>(bytes, at), number_at<float>(bytes, at + 4),
          number_at<float>(bytes, at + 8)};
}

/// The point of a pixel in the world, by what the page reads.
Eigen::Vector3d point_of(const std::vector<std::uint8_t>& bytes, std::size_t pixel) {
  const double unit_m = number_at<float>(bytes, 4);
  Eigen::Vector3d point = vector_at(bytes, 8);
  for (int axis = 0; axis < 3; ++axis) {
    point[axis] += unit_m * number_at<std::int16_t>(
                                bytes, 68 + 6 * pixel + 2 * static_cast<std::size_t>(axis));
  }
  return point;
}

RangeImage image_of(const SensorGeometry& sensor) {
  RangeImage image;
  image.rays = make_ray_table(sensor);
  image.position_m = {1.0, 2.0, 3.0};
  image.world_from_sensor = world_from_sensor_rotation(0.5, -0.2);
  image.range_m.assign(image.rays.pixels(), 2.0F);
  return image;
}

Eigen::Vector3d expected_point(const RangeImage& image, int u, int v) {
  return image.position_m +
         static_cast<double>(
             image.range_m[static_cast<std::size_t>(v * image.rays.columns() + u)]) *
             (image.world_from_sensor * image.rays.ray(u, v));
}

TEST(ScanBytes, HoldEveryPointOfASmallImage) {
  RangeImage image = image_of(TiltedLineScan::with_aperture(6, 4, 1.0));
  for (std::size_t i = 0; i < image.range_m.size(); ++i) {
    image.range_m[i] = 1.0F + 0.1F * static_cast<float>(i);
  }
  image.range_m[3] = std::numeric_limits<float>::infinity();
  image.range_m[4] = std::numeric_limits<float>::quiet_NaN();
  const auto bytes = scan_bytes(image);
  ASSERT_EQ(bytes.size(), 68U + 6U * 24U);
  EXPECT_EQ(number_at<std::uint16_t>(bytes, 0), 6);
  EXPECT_EQ(number_at<std::uint16_t>(bytes, 2), 4);
  EXPECT_TRUE(vector_at(bytes, 8).isApprox(image.position_m, 1e-6));
  const int corners[4][2] = {{0, 0}, {5, 0}, {0, 3}, {5, 3}};
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const Eigen::Vector3d ray =
        image.world_from_sensor * image.rays.ray(corners[corner][0], corners[corner][1]);
    EXPECT_TRUE(vector_at(bytes, 20 + 12 * corner).isApprox(ray, 1e-6)) << corner;
  }
  for (int v = 0; v < 4; ++v) {
    for (int u = 0; u < 6; ++u) {
      const auto pixel = static_cast<std::size_t>(6 * v + u);
      const auto first = number_at<std::int16_t>(bytes, 68 + 6 * pixel);
      if (pixel == 3) {
        EXPECT_EQ(first, 32767) << "no return";
      } else if (pixel == 4) {
        EXPECT_EQ(first, 0) << "invalid";
      } else {
        // Half a unit of a 32000th of 3.3 m along each axis.
        EXPECT_LT((point_of(bytes, pixel) - expected_point(image, u, v)).norm(), 1e-4);
      }
    }
  }
}

TEST(ScanBytes, OfUprightLinesAreThePicture) {
  SphericalScanner scanner;
  scanner.columns = 5;
  scanner.rows = 3;
  RangeImage image = image_of(scanner);
  ASSERT_EQ(image.rays.columns(), 3) << "a line of the image stands upright";
  for (std::size_t i = 0; i < image.range_m.size(); ++i) {
    image.range_m[i] = 1.0F + 0.1F * static_cast<float>(i);
  }
  const auto bytes = scan_bytes(image);
  ASSERT_EQ(number_at<std::uint16_t>(bytes, 0), 5);
  ASSERT_EQ(number_at<std::uint16_t>(bytes, 2), 3);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 5; ++column) {
      EXPECT_LT((point_of(bytes, static_cast<std::size_t>(5 * row + column)) -
                 expected_point(image, row, column))
                    .norm(),
                1e-4);
    }
  }
}

TEST(ScanBytes, OfALargeImageAreThinnedOut) {
  const auto bytes = scan_bytes(image_of(TiltedLineScan::with_aperture(1000, 300, 1.0)));
  EXPECT_EQ(number_at<std::uint16_t>(bytes, 0), kScanColumns);
  EXPECT_EQ(number_at<std::uint16_t>(bytes, 2), kScanRows);
  EXPECT_EQ(bytes.size(), 68U + 6U * kScanColumns * kScanRows);
}

}  // namespace
}  // namespace nextview
