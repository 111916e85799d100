// MapBuilder against its plain twin, voxel by voxel, over random worlds, windows and views.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "mapper/map_builder.h"
#include "mapper/map_digest.h"
#include "mapper/reference_map_update.h"
#include "tests/mapper/analytic_world.h"

namespace nextview {
namespace {

AnalyticWorld random_world(RandomStream& random, const Eigen::Vector3d& min,
                           const Eigen::Vector3d& max) {
  const auto point = [&] {
    return Eigen::Vector3d(uniform(random, min[0], max[0]), uniform(random, min[1], max[1]),
                           uniform(random, min[2], max[2]));
  };
  AnalyticWorld world;
  const double margin = 0.1 * (max - min).norm();
  if (random.below(4) != 0) {  // a room a little smaller or larger than the window
    const auto shift = [&] { return Eigen::Vector3d::Constant(uniform(random, -margin, margin)); };
    world.boxes.push_back({min + shift(), max + shift()});
  }
  for (std::uint32_t n = random.below(3); n > 0; --n) {
    const Eigen::Vector3d corner = point();
    world.boxes.push_back({corner, corner + Eigen::Vector3d::Constant(uniform(random, 0.1, 1.0))});
  }
  for (std::uint32_t n = random.below(3); n > 0; --n) {
    world.spheres.push_back({point(), uniform(random, 0.1, 0.5) * margin});
  }
  if (random.below(2) == 0) {
    const Eigen::Vector3d normal = (point() - point()).normalized();
    world.planes.push_back({normal, normal.dot(point())});
  }
  return world;
}

struct Case {
  VoxelGrid grid;
  MapWindow window;
  AnalyticWorld world;

  Eigen::Vector3d corner_m(int which) const {
    return grid.center_m(window.min + which * (window.size - VoxelIndex::Ones()));
  }
};

Case random_case(RandomStream& random) {
  Case c;
  c.grid.voxel_size_m = random.below(2) == 0 ? 0.1 : uniform(random, 0.02, 0.3);
  for (int axis = 0; axis < 3; ++axis) {
    if (random.below(2) == 0) c.grid.origin_m[axis] = uniform(random, -5.0, 5.0);
    c.window.min[axis] = uniform_int(random, -40, 40);
    const int sizes[] = {1, 7, 8, 9, 16, 17, 20, 24};
    c.window.size[axis] = sizes[random.below(8)];
  }
  c.world = random_world(random, c.corner_m(0), c.corner_m(1));
  return c;
}

SensorGeometry random_sensor(RandomStream& random) {
  const int columns = uniform_int(random, 2, 24);
  const int rows = uniform_int(random, 2, 16);
  switch (random.below(4)) {
    case 0: {
      const double turn = 2.0 * std::numbers::pi;
      return SphericalScanner{columns, rows,
                              random.below(2) == 0 ? turn : uniform(random, 0.1, turn),
                              uniform(random, 0.02, 3.0)};
    }
    case 1:
      return LineStriper{columns, rows, uniform(random, 0.02, 3.0), uniform(random, 0.02, 3.0),
                         0.0};
    default:
      return TiltedLineScan::with_aperture(columns, rows, uniform(random, 0.02, 1.5));
  }
}

RangeImage random_view(const Case& c, RandomStream& random) {
  const SensorGeometry sensor = random_sensor(random);
  SensorPose pose;
  for (int axis = 0; axis < 3; ++axis) {
    pose.position_m[axis] = uniform(random, c.corner_m(0)[axis], c.corner_m(1)[axis]);
  }
  pose.pan_rad = uniform(random, -std::numbers::pi, std::numbers::pi);
  pose.tilt_rad = uniform(random, -0.5, 0.5) * std::numbers::pi;
  if (random.below(4) == 0) {  // rays along axes and through the corners of voxels
    pose.position_m = c.grid.center_m(c.grid.voxel_of(pose.position_m));
    pose.pan_rad = 0.5 * std::numbers::pi * uniform_int(random, -2, 2);
    pose.tilt_rad = 0.5 * std::numbers::pi * uniform_int(random, -1, 1);
  }
  RangeLimits limits;
  limits.min_m = random.below(2) == 0 ? 0.0 : 0.3;
  limits.max_m = random.below(3) == 0 ? 1e7 : uniform(random, 0.5, 6.0);
  const double noise_m = random.below(2) == 0 ? 0.0 : 0.02;
  RangeImage image = scan_world(c.world, make_ray_table(sensor), limits, pose, noise_m, &random);
  for (float& range_m : image.range_m) {
    switch (random.below(40)) {
      case 0:
        range_m = std::numeric_limits<float>::quiet_NaN();
        break;
      case 1:
        range_m = std::numeric_limits<float>::infinity();
        break;
      case 2:
        range_m = static_cast<float>(uniform(random, 0.0, 5.0));
        break;
      case 3:
        range_m = random.below(2) == 0 ? 0.0f : 3e38f;
        break;
      default:
        break;
    }
    if (range_m < 0.0f) range_m = 0.0f;
  }
  return image;
}

// Plain comparisons, and a failure for the first voxel that differs only: GoogleTest's own take
// most of the time over millions of voxels.
bool same_surface(const SurfaceVoxel* a, const SurfaceVoxel* b) {
  if (a == nullptr || b == nullptr) return a == b;
  return a->normal_sum == b->normal_sum && a->normal_count == b->normal_count &&
         a->quality == b->quality;
}

void expect_equal_maps(const VoxelMap& map, const ReferenceMapUpdate& reference) {
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

void expect_equal_statistics(const MapStatistics& a, const MapStatistics& b) {
  EXPECT_EQ(a.voxels, b.voxels);
  EXPECT_EQ(a.occupied_faces, b.occupied_faces);
  EXPECT_EQ(a.occlusion_plane_faces, b.occlusion_plane_faces);
  EXPECT_EQ(a.occupied_area_m2, b.occupied_area_m2);
  EXPECT_EQ(a.occlusion_plane_area_m2, b.occlusion_plane_area_m2);
  EXPECT_EQ(a.mean_quality, b.mean_quality);
  EXPECT_EQ(a.min_quality, b.min_quality);
}

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
    const Case c = random_case(random);
    MapBuilder builder(c.grid, c.window);
    ReferenceMapUpdate reference(c.grid, c.window);
    for (int view = uniform_int(random, 1, 4); view > 0; --view) {
      const RangeImage image = random_view(c, random);
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
    Case c = random_case(random);
    MapBuilder builder(c.grid, c.window);
    ReferenceMapUpdate reference(c.grid, c.window);
    for (int step = 0; step < 8; ++step) {
      const RangeImage image = random_view(c, random);
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
    Case c;
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
