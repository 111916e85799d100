#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "bench/ray_meeting.h"
#include "bench/textbook_ray_walk.h"
#include "mapper/voxel_map.h"

namespace nextview {

/// What OctoMap says a ray meets: castRay through a tree with our labels.
///
/// Empty is free in the tree, Occupied is occupied, everything else is not there at all, which
/// OctoMap takes for unknown. castRay with ignoreUnknownCells = false stops at unknown; which kind
/// of unknown OctoMap cannot say, so that is looked up in a dense array, which costs next to
/// nothing. The tree is pruned, as OctoMap's users have it.
class OctomapCaster {
 public:
  OctomapCaster(const VoxelMap& map, double reach_voxels);
  ~OctomapCaster();
  Meeting cast(const VoxelIndex& sensor, const Eigen::Vector3d& direction) const;

 private:
  struct Tree;
  DenseLabels dense_;
  double reach_m_;
  std::unique_ptr<Tree> tree_;
};

/// OctoMap's own map update: insertPointCloud with its default probabilities. It marks free and
/// occupied voxels only.
class OctomapMap {
 public:
  /// How insertPointCloud is called.
  enum class Insertion {
    Exact,                     ///< its defaults: one ray a point, inner nodes kept up to date
    DiscretizedLazy,           ///< one ray a distinct end voxel, inner nodes left alone
    DiscretizedLazyThenInner,  ///< the same, then updateInnerOccupancy
  };
  /// Points as OctoMap wants them.
  class Cloud {
   public:
    Cloud(const Eigen::Vector3d& sensor_m, std::span<const Eigen::Vector3d> points_m,
          double voxel_size_m);
    ~Cloud();
    Cloud(Cloud&&) noexcept;

   private:
    friend class OctomapMap;
    struct Points;
    std::unique_ptr<Points> points_;
  };

  explicit OctomapMap(double voxel_size_m);
  ~OctomapMap();
  void insert(const Cloud& cloud, Insertion insertion);
  /// Empty, Occupied, or Unmarked for what is not in the tree.
  Label label(const VoxelIndex& voxel) const;
  std::size_t memory_bytes() const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace nextview
