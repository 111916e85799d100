#pragma once

#include <cstdint>

#include "planner/prediction/normal_scatter.h"

namespace nextview {

/// What the rays of one predicted view would meet first (P15), and what is known of the surfaces
/// they meet (P17, P18). The surface counts stay 0 when they are not asked for.
struct ViewCounts {
  std::int64_t occupied = 0;         ///< rays that meet an Occupied voxel
  std::int64_t occlusion_plane = 0;  ///< rays that meet an OcclusionPlane voxel
  std::int64_t unseen = 0;           ///< rays that meet an Unmarked or an Occluded voxel
  std::int64_t open = 0;  ///< rays that meet only Empty up to the window's or the sensor's limit

  // Surface counts.
  std::int64_t occupied_voxels = 0;  ///< distinct Occupied voxels met
  std::int64_t improved_voxels = 0;  ///< those predicted to be seen better than ever before
  std::int64_t improvement = 0;  ///< their gains in quality, summed, 1/SurfaceVoxel::kQualityUnit
  NormalScatter normals = {};    ///< of the distinct Occupied voxels met that have a normal

  bool operator==(const ViewCounts& other) const = default;
};

}  // namespace nextview
