#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "mapper/voxel_map.h"
#include "sensor/sensor_pose.h"

namespace nextview {

/// From where a picture is taken and how large it is.
struct PictureView {
  int width = 1600;            ///< pixels
  int height = 1000;           ///< pixels
  double azimuth_deg = 245.0;  ///< from where the map's middle is looked at, 0 = from +x, 90 = +y
  double elevation_deg = 48.0;
};

/// An image of 8-bit red, green and blue, row by row from the top.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

/// The recovered scene as in figure 9 of the paper: the Occupied voxels' faces that touch Empty
/// space, coloured by height, with the sensor's path dashed and its poses and directions drawn.
/// Faces are seen from their Empty side only, so one looks through ceiling and walls into the room.
/// @throws std::invalid_argument when no voxel is Occupied
Picture recovered_picture(const VoxelMap& map, std::span<const SensorPose> poses,
                          const PictureView& view);

/// The picture as the bytes of a PNG file.
std::vector<std::uint8_t> png_bytes(const Picture& picture);

/// @throws std::runtime_error naming the file when it cannot be written
void write_png(const Picture& picture, const std::filesystem::path& file);

}  // namespace nextview
