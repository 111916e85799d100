#pragma once

#include <Eigen/Core>
#include <span>

#include "bench/textbook_ray_walk.h"
#include "sensor/range_image.h"

namespace nextview {

/// The map update as a textbook has it (P12 over a dense array): for every point one walk in double
/// from the sensor's position, Empty up to the point, Occupied at it, Occluded behind it. Neither
/// occlusion planes, normals nor quality.
class TextbookMap {
 public:
  TextbookMap(const VoxelGrid& grid, const MapWindow& window) : grid_(grid), dense_(window) {}
  void insert(const Eigen::Vector3d& sensor_m, std::span<const Eigen::Vector3d> points_m);
  const DenseLabels& labels() const { return dense_; }

 private:
  VoxelGrid grid_;
  DenseLabels dense_;
};

/// The sensed points of a range image in the world (eq. 1), for those who start from points.
std::vector<Eigen::Vector3d> sensed_points_m(const RangeImage& image);

}  // namespace nextview
