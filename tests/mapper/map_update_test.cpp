// MapBuilder against its plain twin, voxel by voxel, over random worlds, windows and views.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "mapper/map_builder.h"
#include "mapper/map_digest.h"
#include "mapper/reference_map_update.h"
#include "tests/mapper/same_map.h"
#include "tests/mapper/small_world.h"

namespace nextview {
namespace {

void expect_report(const FoldReport& report, const std::vector<Label>& before, const VoxelMap& map,
                   const RangeImage& image) {
  EXPECT_EQ(report.points + report.points_outside + report.no_returns + report.invalid,
            static_cast<std::int64_t>(image.range_m.size()));
  std::vector<std::uint32_t> changed;
  std::int64_t newly_occupied = 0;
  for (std::uint32_t slot = 0; slot < before.size(); ++slot) {
    if (before[slot] == map.labels()[slot]) continue;
    changed.push_back(slot);
    if (map.labels()[slot] == Label::Occupied) ++newly_occupied;
  }
  EXPECT_EQ(report.newly_occupied, newly_occupied);
  std::vector<std::uint32_t> reported = report.changed_slots;
  std::sort(reported.begin(), reported.end());
  EXPECT_EQ(reported, changed);
}

// The surface data of every voxel of the window, by slot.
std::vector<std::optional<SurfaceVoxel>> surfaces_of(const VoxelMap& map) {
  std::vector<std::optional<SurfaceVoxel>> surfaces(map.labels().size());
  const VoxelIndex end = map.window().min + map.window().size;
  for (int k = map.window().min[2]; k < end[2]; ++k) {
    for (int j = map.window().min[1]; j < end[1]; ++j) {
      for (int i = map.window().min[0]; i < end[0]; ++i) {
        const SurfaceVoxel* surface = map.surface({i, j, k});
        if (surface != nullptr) surfaces[map.slot({i, j, k})] = *surface;
      }
    }
  }
  return surfaces;
}

void expect_updated_surfaces(const FoldReport& report,
                             const std::vector<std::optional<SurfaceVoxel>>& before,
                             const VoxelMap& map) {
  const auto after = surfaces_of(map);
  std::vector<std::uint32_t> different;
  for (std::uint32_t slot = 0; slot < after.size(); ++slot) {
    if (!same_surface(before[slot] ? &*before[slot] : nullptr,
                      after[slot] ? &*after[slot] : nullptr)) {
      different.push_back(slot);
    }
  }
  std::vector<std::uint32_t> reported = report.updated_surfaces;
  std::sort(reported.begin(), reported.end());
  EXPECT_EQ(reported, different);
}

TEST(MapUpdate, EqualsItsPlainTwinOverRandomWorldsAndViews) {
  int views = 0;
  std::int64_t points = 0;
  std::int64_t planes = 0;
  std::int64_t with_normal = 0;
  for (int n = 0; n < 1000; ++n) {
    SCOPED_TRACE("case " + std::to_string(n));
    RandomStream random(n, 1, 1, RandomPurpose::RangeNoise);
    const SmallWorld c = random_small_world(random);
    MapBuilder builder(c.grid, c.window);
    ReferenceMapUpdate reference(c.grid, c.window);
    for (int view = uniform_int(random, 1, 4); view > 0; --view) {
      const RangeImage image = random_view(c, random_sensor(random), random);
      const std::vector<Label> before(builder.map().labels().begin(), builder.map().labels().end());
      const auto surfaces_before = surfaces_of(builder.map());
      const FoldReport& report = builder.fold(image);
      reference.fold(image);
      expect_updated_surfaces(report, surfaces_before, builder.map());
      expect_equal_maps(builder.map(), reference);
      expect_equal_statistics(builder.statistics(), reference.statistics());
      expect_report(report, before, builder.map(), image);
      EXPECT_EQ(builder.digest(), map_digest(builder.map()));
      if (HasFailure()) return;
      ++views;
      points += report.points;
      planes += builder.statistics().occlusion_plane_faces;
      with_normal += builder.statistics().mean_quality > 0.0;
    }
  }
  // The random worlds do exercise what is compared.
  EXPECT_GT(views, 2000);
  EXPECT_GT(points, 50'000);
  EXPECT_GT(planes, 10'000);
  EXPECT_GT(with_normal, 1000);
  std::cout << views << " views, " << points << " points, " << with_normal
            << " views with normals\n";
}

VoxelIndex random_step(RandomStream& random, const MapWindow& window) {
  const int reach = random.below(8) == 0 ? 60 : 5;  // sometimes past everything it holds
  VoxelIndex step;
  for (int axis = 0; axis < 3; ++axis) {
    step[axis] = random.below(2) == 0 ? 0 : uniform_int(random, -reach, reach);
  }
  return window.min + step;
}

TEST(MapUpdate, EqualsItsPlainTwinWhileTheWindowMoves) {
  int moves = 0;
  std::int64_t forgotten = 0;
  std::int64_t changed_by_moves = 0;
  for (int n = 0; n < 900; ++n) {
    SCOPED_TRACE("case " + std::to_string(n));
    RandomStream random(n, 1, 2, RandomPurpose::RangeNoise);
    SmallWorld c = random_small_world(random);
    MapBuilder builder(c.grid, c.window);
    ReferenceMapUpdate reference(c.grid, c.window);
    for (int step = 0; step < 8; ++step) {
      const RangeImage image = random_view(c, random_sensor(random), random);
      builder.fold(image);
      reference.fold(image);
      if (random.below(2) == 0) builder.digest();  // also hashed late, over several moves
      const ReferenceMapUpdate before = reference;
      const VoxelIndex new_min = random_step(random, c.window);
      const auto slots = builder.move_window(new_min);
      std::vector<std::uint32_t> reported(slots.begin(), slots.end());
      reference.move_window(new_min);
      std::vector<std::uint32_t> changed;
      for_each_voxel(c.window, [&](const VoxelIndex& voxel) {
        if (!builder.map().contains(voxel)) {
          forgotten += before.label(voxel) != Label::Unmarked;
        } else if (before.label(voxel) != builder.map().label(voxel)) {
          changed.push_back(static_cast<std::uint32_t>(builder.map().slot(voxel)));
        }
      });
      std::sort(changed.begin(), changed.end());
      std::sort(reported.begin(), reported.end());
      EXPECT_EQ(reported, changed);
      c.window.min = new_min;
      expect_equal_maps(builder.map(), reference);
      expect_equal_statistics(builder.statistics(), reference.statistics());
      EXPECT_EQ(builder.digest(), map_digest(builder.map()));
      if (HasFailure()) return;
      ++moves;
      changed_by_moves += static_cast<std::int64_t>(changed.size());
    }
  }
  EXPECT_EQ(moves, 7200);
  EXPECT_GT(forgotten, 100'000);
  EXPECT_GT(changed_by_moves, 150);
  std::cout << forgotten << " voxels forgotten, " << changed_by_moves << " planes closed\n";
}

// Points on the face between two voxels, or nearer to it than a product can tell.
TEST(MapUpdate, EqualsItsPlainTwinWherePointsLieOnTheFacesOfVoxels) {
  constexpr double kSizes_m[] = {0.125, 0.1, 0.05, 0.3, 0.001, 7.0};
  std::int64_t points = 0;
  for (int n = 0; n < 600; ++n) {
    SCOPED_TRACE("case " + std::to_string(n));
    RandomStream random(n, 1, 1, RandomPurpose::RangeNoise);
    SmallWorld c;
    c.grid.voxel_size_m = kSizes_m[random.below(6)];
    const double half_m = 0.5 * c.grid.voxel_size_m;
    c.window = {VoxelIndex::Constant(-10), VoxelIndex::Constant(21)};
    const VoxelIndex sensor(uniform_int(random, -4, 4), uniform_int(random, -4, 4), 0);
    SensorPose pose;
    pose.position_m = c.grid.center_m(sensor);
    pose.pan_rad = 0.5 * std::numbers::pi * uniform_int(random, -2, 2);
    pose.tilt_rad = 0.5 * std::numbers::pi * uniform_int(random, -1, 1);
    // The middle ray of an odd number looks along an axis.
    const RayTable rays = make_ray_table(TiltedLineScan::with_aperture(5, 3, 0.5));
    RangeImage image = scan_world({}, rays, {0.0, 30.0}, pose);
    for (float& range_m : image.range_m) {
      range_m = static_cast<float>(half_m * uniform_int(random, 0, 30));
      if (random.below(3) == 0)
        range_m = std::nextafterf(range_m, random.below(2) == 0 ? 0.0f : 1e9f);
      range_m = std::max(range_m, 0.0f);
    }
    MapBuilder builder(c.grid, c.window);
    ReferenceMapUpdate reference(c.grid, c.window);
    points += builder.fold(image).points;
    reference.fold(image);
    expect_equal_maps(builder.map(), reference);
    if (HasFailure()) return;
  }
  EXPECT_GT(points, 3000);
}

}  // namespace
}  // namespace nextview
