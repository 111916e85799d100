#include "bench/octomap_map.h"

#include <octomap/OcTree.h>

namespace nextview {

namespace {

// Our voxel i covers [i - 1/2, i + 1/2) voxel sizes, OctoMap's cell [k, k + 1): half a voxel lies
// between the two worlds.
constexpr int kZeroKey = 32768;

octomap::OcTreeKey key_of_voxel(const VoxelIndex& voxel) {
  octomap::OcTreeKey key;
  for (unsigned axis = 0; axis < 3; ++axis) {
    key[axis] = static_cast<octomap::key_type>(voxel[static_cast<int>(axis)] + kZeroKey);
  }
  return key;
}

VoxelIndex voxel_of_key(const octomap::OcTreeKey& key) {
  return VoxelIndex(key[0], key[1], key[2]) - VoxelIndex::Constant(kZeroKey);
}

octomap::point3d octomap_point(const Eigen::Vector3d& point_m, double voxel_size_m) {
  const Eigen::Vector3f p = (point_m + Eigen::Vector3d::Constant(0.5 * voxel_size_m)).cast<float>();
  return {p.x(), p.y(), p.z()};
}

}  // namespace

struct OctomapCaster::Tree {
  explicit Tree(double voxel_size_m) : tree(voxel_size_m) {}
  octomap::OcTree tree;
};

OctomapCaster::OctomapCaster(const VoxelMap& map, double reach_voxels)
    : dense_(map),
      reach_m_(reach_voxels * map.grid().voxel_size_m),
      tree_(std::make_unique<Tree>(map.grid().voxel_size_m)) {
  const MapWindow& window = map.window();
  for (int k = 0; k < window.size[2]; ++k) {
    for (int j = 0; j < window.size[1]; ++j) {
      for (int i = 0; i < window.size[0]; ++i) {
        const VoxelIndex voxel = window.min + VoxelIndex(i, j, k);
        const Label label = map.label(voxel);
        if (label == Label::Empty || label == Label::Occupied) {
          tree_->tree.updateNode(key_of_voxel(voxel), label == Label::Occupied, true);
        }
      }
    }
  }
  tree_->tree.updateInnerOccupancy();
  tree_->tree.prune();
}

OctomapCaster::~OctomapCaster() = default;

Meeting OctomapCaster::cast(const VoxelIndex& sensor, const Eigen::Vector3d& direction) const {
  const octomap::OcTree& tree = tree_->tree;
  octomap::point3d end;
  const bool occupied = tree.castRay(
      tree.keyToCoord(key_of_voxel(sensor)),
      octomap::point3d(static_cast<float>(direction.x()), static_cast<float>(direction.y()),
                       static_cast<float>(direction.z())),
      end, false, reach_m_);
  if (occupied) return Meeting::Occupied;
  octomap::OcTreeKey key;
  if (!tree.coordToKeyChecked(end, key)) return Meeting::Open;
  const VoxelIndex voxel = voxel_of_key(key);
  return dense_.window.contains(voxel) ? meeting_of(dense_.at(voxel)) : Meeting::Open;
}

struct OctomapMap::Tree {
  explicit Tree(double voxel_size_m) : tree(voxel_size_m) {}
  octomap::OcTree tree;
};

struct OctomapMap::Cloud::Points {
  octomap::point3d sensor;
  octomap::Pointcloud cloud;
};

OctomapMap::Cloud::Cloud(const Eigen::Vector3d& sensor_m, std::span<const Eigen::Vector3d> points_m,
                         double voxel_size_m)
    : points_(std::make_unique<Points>()) {
  points_->sensor = octomap_point(sensor_m, voxel_size_m);
  for (const Eigen::Vector3d& point_m : points_m) {
    points_->cloud.push_back(octomap_point(point_m, voxel_size_m));
  }
}

OctomapMap::Cloud::~Cloud() = default;
OctomapMap::Cloud::Cloud(Cloud&&) noexcept = default;

OctomapMap::OctomapMap(double voxel_size_m) : tree_(std::make_unique<Tree>(voxel_size_m)) {}
OctomapMap::~OctomapMap() = default;

void OctomapMap::insert(const Cloud& cloud, Insertion insertion) {
  const bool fast = insertion != Insertion::Exact;
  tree_->tree.insertPointCloud(cloud.points_->cloud, cloud.points_->sensor, -1.0, fast, fast);
  if (insertion == Insertion::DiscretizedLazyThenInner) tree_->tree.updateInnerOccupancy();
}

Label OctomapMap::label(const VoxelIndex& voxel) const {
  const octomap::OcTreeNode* node = tree_->tree.search(key_of_voxel(voxel));
  if (node == nullptr) return Label::Unmarked;
  return tree_->tree.isNodeOccupied(node) ? Label::Occupied : Label::Empty;
}

std::size_t OctomapMap::memory_bytes() const { return tree_->tree.memoryUsage(); }

}  // namespace nextview
