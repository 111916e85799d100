#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <unordered_map>

#include "mapper/voxel_map.h"
#include "sensor/range_image.h"

namespace nextview {

/// The sensed points of a run, summed up: for each voxel and each of the six sides a surface can
/// show, the mean of the points in it and the mean of their normals. So floor and wall in one voxel
/// stay two planes, and so do the two sides of a thin board. Memory grows with the Occupied voxels,
/// not with the points.
class OrientedPoints {
 public:
  /// The points of one voxel whose normals are nearest to one direction of an axis.
  struct Plane {
    Eigen::Vector3d position_sum_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal_sum = Eigen::Vector3d::Zero();
    double points = 0.0;

    Eigen::Vector3d position_m() const { return position_sum_m / points; }
    Eigen::Vector3d normal() const { return normal_sum.normalized(); }
  };
  using Planes = std::array<Plane, 6>;  ///< +x, -x, +y, -y, +z, -z

  explicit OrientedPoints(const VoxelGrid& grid) : grid_(grid) {}

  /// Takes in the points of an image that have a normal.
  void add(const RangeImage& image);

  /// nullptr when no point with a normal fell in the voxel. Some of the six may have no points.
  const Planes* at(const VoxelIndex& voxel) const;

 private:
  struct IndexHash {
    std::size_t operator()(const VoxelIndex& index) const;
  };
  VoxelGrid grid_;
  std::unordered_map<VoxelIndex, Planes, IndexHash> planes_;
};

}  // namespace nextview
