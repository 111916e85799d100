// Where known free space ends on what surfaces hide, held against geometry (P12): every pixel's ray
// is followed voxel by voxel through the CAD model, and what it passes before it meets a surface is
// free, what comes behind hidden. Of the map only what is Occupied is believed.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <optional>
#include <vector>

#include "tests/system/explored_room.h"

namespace nextview {
namespace {

enum class Sight : std::uint8_t { Nobody, Behind, Into };

/// Of every voxel, whether a ray has passed it before it met a surface; else whether one would have
/// behind that.
class SightOfVoxels {
 public:
  explicit SightOfVoxels(const VoxelMap& map)
      : grid_(map.grid()),
        window_(map.window()),
        best_(static_cast<std::size_t>(window_.size.prod()), Sight::Nobody) {}

  void follow(const Scene& scene, const Eigen::Vector3d& from_m, const Eigen::Vector3d& direction) {
    const auto hit = scene.first_hit(from_m, direction);
    const double hit_m = hit ? double{hit->distance_m} : HUGE_VAL;
    // A voxel further along the longest axis, as the lines of the map's update go.
    const double step_m = grid_.voxel_size_m / direction.cwiseAbs().maxCoeff();
    for (int n = 0;; ++n) {
      const double way_m = n * step_m;
      const VoxelIndex voxel = grid_.voxel_of(from_m + way_m * direction);
      if (!window_.contains(voxel)) return;
      Sight& best = best_[number(voxel)];
      best = std::max(best, way_m < hit_m ? Sight::Into : Sight::Behind);
    }
  }

  /// Between voxels that have been seen into and hidden ones; Occupied are neither.
  std::int64_t hidden_faces(const VoxelMap& map) const {
    const auto is = [&](const VoxelIndex& voxel, Sight sight) {
      return window_.contains(voxel) && map.label(voxel) != Label::Occupied &&
             best_[number(voxel)] == sight;
    };
    std::int64_t faces = 0;
    for_each_voxel(window_, [&](const VoxelIndex& voxel) {
      if (!is(voxel, Sight::Behind)) return;
      for (int axis = 0; axis < 3; ++axis) {
        for (const int step : {-1, 1}) {
          VoxelIndex beside = voxel;
          beside[axis] += step;
          faces += is(beside, Sight::Into);
        }
      }
    });
    return faces;
  }

 private:
  std::size_t number(const VoxelIndex& voxel) const {
    const VoxelIndex step = voxel - window_.min;
    return static_cast<std::size_t>((step[2] * window_.size[1] + step[1]) * window_.size[0] +
                                    step[0]);
  }

  VoxelGrid grid_;
  MapWindow window_;
  std::vector<Sight> best_;
};

TEST(HiddenFaces, AreThoseOfGeometryAfterTwentyViewsOfColumns) {
  constexpr int kViews = 20;
  const RunSetup setup = room_setup("columns", "paper", 1, kViews);
  std::optional<SightOfVoxels> sight;
  std::int64_t by_geometry = 0;
  std::int64_t faces = 0;
  explore(setup, [&](const ViewPlanner& planner, const FoldReport&, const RangeImage& image) {
    if (!sight) sight.emplace(planner.map());
    for (int v = 0; v < image.rays.rows(); ++v) {
      for (int u = 0; u < image.rays.columns(); ++u) {
        sight->follow(*setup.scene, image.position_m,
                      image.world_from_sensor * image.rays.ray(u, v));
      }
    }
    if (planner.views() < kViews) return;
    faces = planner.builder().statistics().occlusion_plane_faces;
    by_geometry = sight->hidden_faces(planner.map());
  });
  std::cout << faces << " faces of occlusion planes, by geometry " << by_geometry << "\n";
  EXPECT_GT(by_geometry, 3000);
  // The map has a fifth more: in front of a voxel that several rays meet it draws one line, to the
  // voxel's centre, and leaves between such lines what the rays themselves have passed. Were one
  // line per voxel all that is drawn behind it too, it would have half of them.
  const double share = static_cast<double>(faces) / static_cast<double>(by_geometry);
  EXPECT_GT(share, 1.15);
  EXPECT_LT(share, 1.25);
}

}  // namespace
}  // namespace nextview
