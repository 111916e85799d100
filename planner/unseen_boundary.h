#pragma once

#include <string>
#include <vector>

#include "mapper/voxel_map.h"
#include "planner/clear_space.h"
#include "planner/shortest_paths.h"

namespace nextview {

/// The best place an unknown voxel could be looked at from, as far as is known; the worst first.
enum class UnseenFrom { Nowhere, TooNear, NoPath, BeyondLift, Refused, InView };
constexpr int kUnseenFromCount = 6;

/// An unknown voxel that touches Empty ones.
struct UnseenVoxel {
  VoxelIndex voxel;
  int empty_faces = 0;  ///< of its six
  UnseenFrom from = UnseenFrom::Nowhere;
};

/// All of them, x fastest. Each is looked for along 80 directions up to a range.
std::vector<UnseenVoxel> unseen_voxels(const VoxelMap& map, const ClearSpace& space,
                                       const ShortestPaths& paths, double range_m);

/// What is left unseen, and why: the area of the faces between Empty and unknown voxels, by the
/// best place it could be looked at from, as far as is known. Each face is in one of them.
struct UnseenBoundary {
  double in_view_m2 =
      0.0;  ///< from a position with a path: views of it showed or promise too little
  double refused_m2 = 0.0;       ///< only from where the base refused to go
  double beyond_lift_m2 = 0.0;   ///< only from beyond the lift or the workspace
  double no_path_m2 = 0.0;       ///< only from clear space that no path leads to
  double too_near_m2 = 0.0;      ///< only from nearer to obstacles than the clearance
  double from_nowhere_m2 = 0.0;  ///< from nothing that is known to be Empty, its own face aside

  double total_m2() const {
    return in_view_m2 + refused_m2 + beyond_lift_m2 + no_path_m2 + too_near_m2 + from_nowhere_m2;
  }
};

/// The areas of unseen_voxels().
UnseenBoundary unseen_boundary(const VoxelMap& map, const ClearSpace& space,
                               const ShortestPaths& paths, double range_m);

/// For people: "1.32 m2 of boundary left unseen: 0.80 m2 too near, ...".
std::string describe(const UnseenBoundary& boundary);

}  // namespace nextview
