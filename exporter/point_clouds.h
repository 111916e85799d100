#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <ostream>
#include <span>

#include "exporter/point_file.h"
#include "mapper/voxel_map.h"
#include "sensor/range_image.h"

namespace nextview {

/// The Occupied voxels of a map in the order of their indices, x fastest: centre, mean normal
/// towards the sensor (0, 0, 0 where there is none), quality in 0..1.
void write_occupied_voxels(std::ostream& out, PointFormat format, const VoxelMap& map);

/// The same with one field more, `filled`: 0 for these, which were sensed. Behind them come voxels
/// that were not, with 1, no normal and quality 0.
void write_filled_voxels(std::ostream& out, PointFormat format, const VoxelMap& map,
                         std::span<const VoxelIndex> filled);

/// A sensed point (eq. 1), world frame.
struct SensedPoint {
  Eigen::Vector3d position_m;
  Eigen::Vector3d normal;  ///< unit vector towards the sensor, as the map sums it; zero: none
};

/// Calls see(point) for every pixel of an image that holds a point, in pixel order.
void for_each_point(const RangeImage& image, const std::function<void(const SensedPoint&)>& see);

/// Every point of the images of view 1, 2, ..., in the order of views and pixels: position, normal,
/// view.
void write_sensed_points(std::ostream& out, PointFormat format,
                         std::span<const RangeImage* const> images);

}  // namespace nextview
