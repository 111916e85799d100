#pragma once

#include <gtest/gtest.h>

#include "mapper/map_builder.h"
#include "mapper/reference_map_update.h"

namespace nextview {

/// Plain comparisons, and a failure for the first voxel that differs only: GoogleTest's own take
/// most of the time over millions of voxels.
inline bool same_surface(const SurfaceVoxel* a, const SurfaceVoxel* b) {
  if (a == nullptr || b == nullptr) return a == b;
  return a->normal_sum == b->normal_sum && a->normal_count == b->normal_count &&
         a->quality == b->quality;
}

template <typename Map>  // VoxelMap, or what has the same questions
void expect_equal_maps(const Map& map, const ReferenceMapUpdate& reference) {
  const MapWindow& window = map.window();
  for (int k = 0; k < window.size[2]; ++k) {
    for (int j = 0; j < window.size[1]; ++j) {
      for (int i = 0; i < window.size[0]; ++i) {
        const VoxelIndex voxel = window.min + VoxelIndex(i, j, k);
        if (map.label(voxel) != reference.label(voxel)) {
          FAIL() << "label " << static_cast<int>(map.label(voxel)) << " for "
                 << static_cast<int>(reference.label(voxel)) << " at " << voxel.transpose();
        }
        if (!same_surface(map.surface(voxel), reference.surface(voxel))) {
          FAIL() << "surface data at " << voxel.transpose();
        }
      }
    }
  }
}

inline void expect_equal_statistics(const MapStatistics& a, const MapStatistics& b) {
  EXPECT_EQ(a.voxels, b.voxels);
  EXPECT_EQ(a.occupied_faces, b.occupied_faces);
  EXPECT_EQ(a.occlusion_plane_faces, b.occlusion_plane_faces);
  EXPECT_EQ(a.occupied_area_m2, b.occupied_area_m2);
  EXPECT_EQ(a.occlusion_plane_area_m2, b.occlusion_plane_area_m2);
  EXPECT_EQ(a.mean_quality, b.mean_quality);
  EXPECT_EQ(a.min_quality, b.min_quality);
}

}  // namespace nextview
