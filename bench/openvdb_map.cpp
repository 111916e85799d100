#include "bench/openvdb_map.h"

#include <openvdb/math/DDA.h>
#include <openvdb/math/Ray.h>
#include <openvdb/openvdb.h>
#include <openvdb/tree/ValueAccessor.h>

#include <limits>

namespace nextview {

namespace {

using LabelTree = openvdb::tree::Tree4<std::uint8_t, 5, 4, 3>::Type;
using Accessor = openvdb::tree::ValueAccessor<LabelTree>;
using ConstAccessor = openvdb::tree::ValueAccessor<const LabelTree>;
using Ray = openvdb::math::Ray<double>;
using Dda = openvdb::math::DDA<Ray, 0>;

/// What lies around the window.
constexpr std::uint8_t kOutside = 255;
constexpr double kFarthest = 1e6;

openvdb::Coord coord_of(const VoxelIndex& voxel) { return {voxel[0], voxel[1], voxel[2]}; }

// Our voxel i covers [i - 1/2, i + 1/2), the DDA's [i, i + 1).
Ray index_ray(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double reach) {
  return Ray(openvdb::Vec3d(origin.x() + 0.5, origin.y() + 0.5, origin.z() + 0.5),
             openvdb::Vec3d(direction.x(), direction.y(), direction.z()), 0.0, reach);
}

}  // namespace

struct OpenvdbCaster::Grid {
  Grid() : tree(kOutside), accessor(tree) {}
  LabelTree tree;
  ConstAccessor accessor;
};

OpenvdbCaster::OpenvdbCaster(const VoxelMap& map, double reach_voxels)
    : grid_(std::make_unique<Grid>()), reach_(reach_voxels) {
  const MapWindow& window = map.window();
  Accessor accessor(grid_->tree);
  for (int k = 0; k < window.size[2]; ++k) {
    for (int j = 0; j < window.size[1]; ++j) {
      for (int i = 0; i < window.size[0]; ++i) {
        const VoxelIndex voxel = window.min + VoxelIndex(i, j, k);
        accessor.setValue(coord_of(voxel), static_cast<std::uint8_t>(map.label(voxel)));
      }
    }
  }
  grid_->tree.prune();
  grid_->accessor.clear();
}

OpenvdbCaster::~OpenvdbCaster() = default;

Meeting OpenvdbCaster::cast(const VoxelIndex& sensor, const Eigen::Vector3d& direction) const {
  Dda dda(index_ray(sensor.cast<double>(), direction, reach_));
  while (dda.step()) {
    const std::uint8_t label = grid_->accessor.getValue(dda.voxel());
    if (label == static_cast<std::uint8_t>(Label::Empty)) continue;
    return label == kOutside ? Meeting::Open : meeting_of(static_cast<Label>(label));
  }
  return Meeting::Open;
}

struct OpenvdbMap::Grid {
  Grid() : tree(static_cast<std::uint8_t>(Label::Unmarked)) {}
  LabelTree tree;
};

OpenvdbMap::OpenvdbMap(const VoxelGrid& grid, const MapWindow& window)
    : voxels_(grid), window_(window), grid_(std::make_unique<Grid>()) {}
OpenvdbMap::~OpenvdbMap() = default;

void OpenvdbMap::insert(const Eigen::Vector3d& sensor_m, std::span<const Eigen::Vector3d> points_m,
                        bool mark_occluded) {
  Accessor accessor(grid_->tree);
  const auto raise = [&accessor](const openvdb::Coord& voxel, Label to) {
    if (accessor.getValue(voxel) < static_cast<std::uint8_t>(to)) {
      accessor.setValue(voxel, static_cast<std::uint8_t>(to));
    }
  };
  const double per_m = 1.0 / voxels_.voxel_size_m;
  const Eigen::Vector3d origin = (sensor_m - voxels_.origin_m) * per_m;
  raise(coord_of(voxels_.voxel_of(sensor_m)), Label::Empty);
  for (const Eigen::Vector3d& point_m : points_m) {
    const Eigen::Vector3d ray = (point_m - sensor_m) * per_m;
    const double range = ray.norm();
    Dda dda(index_ray(origin, ray / range, mark_occluded ? kFarthest : range));
    while (dda.step() && dda.time() < range) raise(dda.voxel(), Label::Empty);
    if (mark_occluded) {
      for (; window_.contains({dda.voxel()[0], dda.voxel()[1], dda.voxel()[2]}); dda.step()) {
        raise(dda.voxel(), Label::Occluded);
      }
    }
    raise(coord_of(voxels_.voxel_of(point_m)), Label::Occupied);
  }
}

Label OpenvdbMap::label(const VoxelIndex& voxel) const {
  return static_cast<Label>(grid_->tree.getValue(coord_of(voxel)));
}

std::size_t OpenvdbMap::memory_bytes() const { return grid_->tree.memUsage(); }

const char* openvdb_version() { return OPENVDB_LIBRARY_VERSION_STRING; }

}  // namespace nextview
