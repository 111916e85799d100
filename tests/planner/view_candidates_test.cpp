#include "planner/view_candidates.h"

#include <gtest/gtest.h>

#include <optional>
#include <random>
#include <vector>

#include "mapper/map_builder.h"
#include "planner/prediction/grown_surface.h"
#include "planner/prediction/orientations.h"
#include "scene/scene.h"
#include "sensor_sim/scan.h"
#include "tests/scoring/room_mesh.h"

namespace nextview {
namespace {

using Eigen::Vector3d;

constexpr double kVoxel_m = 0.1;

// A room with a cupboard and a column, seen from its middle in some directions, and what is made of
// it to judge views.
struct HalfSeenRoom {
  explicit HalfSeenRoom(int views) : builder({kVoxel_m}, {{-2, -2, -2}, {38, 34, 30}}) {
    TriangleMesh mesh = room({3.4, 3.0, 2.5});
    add_box(mesh, {0.0, 2.3, 0.0}, {0.9, 3.0, 1.9});
    add_box(mesh, {2.5, 0.9, 0.0}, {2.8, 1.2, 2.5});
    const Scene scene(mesh);
    const RayTable rays = make_ray_table(TiltedLineScan::paper());
    RandomStream no_noise(1, 1, 1, RandomPurpose::RangeNoise);
    const std::vector<Orientation> orientations = icosahedron_orientations(1);
    std::mt19937 random(static_cast<unsigned>(views));
    for (int view = 0; view < views; ++view) {
      const Orientation& at = orientations[random() % orientations.size()];
      builder.fold(
          scan(scene, rays, RangeLimits(), {kStart_m, at.pan_rad, at.tilt_rad}, 0.0, no_noise));
    }
    field.emplace(builder.map());
    grown.emplace(builder.map());
    in_vain.assign(field->size(), 0);
    clear.emplace(builder.map(), FeasibilityParameters{});
    paths.find(*clear, builder.map(), kStart_m, 0.8);
  }
  SurfaceGain::Known known() const { return {*field, in_vain, &*grown}; }

  const Vector3d kStart_m{1.6, 1.3, 1.2};
  MapBuilder builder;
  std::optional<FreeSpaceField> field;
  std::optional<GrownSurface> grown;
  std::vector<std::uint8_t> in_vain;
  std::optional<ClearSpace> clear;
  ShortestPaths paths;
};

TEST(PositionLattice, IsThePresentPositionAndEveryThirdVoxelOfThoseReached) {
  const HalfSeenRoom room(30);
  const VoxelIndex present = room.clear->grid().voxel_of(room.kStart_m);
  const PositionLattice lattice(room.paths, present, {1, 0, 2}, 3);
  ASSERT_GT(lattice.voxels.size(), 10u);
  EXPECT_EQ(lattice.voxels.front(), present);
  std::size_t on_lattice = 0;
  for (const VoxelIndex& voxel : room.paths.reached()) {
    const bool expected = (voxel[0] - 1) % 3 == 0 && voxel[1] % 3 == 0 && (voxel[2] - 2) % 3 == 0;
    EXPECT_EQ(lattice.holds(voxel), expected);
    on_lattice += expected && voxel != present ? 1 : 0;
  }
  EXPECT_EQ(lattice.voxels.size(), on_lattice + 1);
}

// Against judging every position that a path leads to.
TEST(ViewCandidates, FindWhatIsOffTheLatticeWhereverItIs) {
  SurfaceGain gain(prediction_raster(TiltedLineScan::paper(), RangeLimits()), kVoxel_m,
                   icosahedron_orientations(1), {});
  int found = 0;
  int not_found = 0;
  const HalfSeenRoom room(60);
  const SurfaceGain::Known known = room.known();
  const VoxelIndex present = room.clear->grid().voxel_of(room.kStart_m);
  const PositionLattice lattice(room.paths, present, {0, 1, 0}, 3);
  ViewCandidates every(gain, 0.1);
  every.begin_with(known);
  every.begin_view(1);
  const double most = every.most_valuable(known, room.paths, room.paths.reached()).value;
  ViewCandidates lazy(gain, 0.1);
  lazy.begin_with(known);
  lazy.begin_view(1);
  const double on_lattice = lazy.most_valuable(known, room.paths, lattice.voxels).value;
  ASSERT_GT(on_lattice, 0.0);
  ASSERT_LT(on_lattice, most);
  for (const double share : {0.01, 0.5, 0.9, 1.0, 1.1}) {
    const double least = on_lattice + share * (most - on_lattice);
    const auto candidate = lazy.off_lattice(known, room.paths, lattice, least);
    EXPECT_EQ(candidate.has_value(), least <= most) << share;
    if (candidate) {
      EXPECT_GE(candidate->value, least);
      EXPECT_FALSE(lattice.holds(candidate->voxel));
      EXPECT_EQ(candidate->value, every.judge(known, room.paths, candidate->voxel).value);
    }
    (candidate ? found : not_found) += 1;
  }
  EXPECT_LE(lazy.judged().size(), every.judged().size());
  EXPECT_EQ(found, 4);
  EXPECT_EQ(not_found, 1);
}

}  // namespace
}  // namespace nextview
