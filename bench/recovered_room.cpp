#include "bench/recovered_room.h"

#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "scene/scene_catalog.h"
#include "sensor_sim/scan.h"

namespace nextview {

namespace {

constexpr int kScanColumns = 512;
constexpr int kScanRows = 256;
constexpr std::size_t kPositions = 60;
constexpr double kClearance_m = 0.40;
constexpr double kDegree = std::numbers::pi / 180.0;

std::vector<RangeImage> scan_room() {
  const BenchScene room = load_bench_scene("columns");
  const RayTable rays =
      make_ray_table(TiltedLineScan::with_aperture(kScanColumns, kScanRows, 60.0 * kDegree));
  // x, y, z in metres, pan and tilt in degrees.
  constexpr std::array<std::array<double, 5>, 8> kPoses = {{{0.8, 3.2, 1.2, -90.0, 0.0},
                                                            {0.8, 3.2, 1.2, -150.0, -20.0},
                                                            {5.2, 0.8, 1.5, 30.0, 0.0},
                                                            {5.2, 0.8, 1.5, 85.0, 20.0},
                                                            {3.0, 3.8, 1.0, 170.0, -25.0},
                                                            {1.0, 1.0, 1.8, -30.0, 0.0},
                                                            {5.2, 3.8, 1.4, 130.0, 10.0},
                                                            {3.2, 0.7, 1.6, 15.0, -30.0}}};
  std::vector<RangeImage> images;
  RandomStream no_noise(0, 1, 1, RandomPurpose::RangeNoise);
  for (const auto& [x, y, z, pan, tilt] : kPoses) {
    images.push_back(scan(room.scene, rays, RangeLimits(),
                          {{x, y, z}, pan * kDegree, tilt * kDegree}, 0.0, no_noise));
  }
  return images;
}

std::vector<VoxelIndex> feasible_positions(const VoxelMap& map) {
  RandomStream random(3, 1, 1, RandomPurpose::InitialSimplex);
  std::vector<VoxelIndex> positions;
  while (positions.size() < kPositions) {
    VoxelIndex voxel = map.window().min;
    for (int axis = 0; axis < 3; ++axis) {
      voxel[axis] +=
          static_cast<int>(random.below(static_cast<std::uint32_t>(map.window().size[axis])));
    }
    if (is_clear(map, voxel, kClearance_m)) positions.push_back(voxel);
  }
  return positions;
}

}  // namespace

BenchScene load_bench_scene(const std::string& name) {
  const std::filesystem::path source(NEXTVIEW_SOURCE_DIR);
  const std::filesystem::path shared = source / ".." / "shared" / "scenes";
  const SceneDescription description = find_scene(
      name, std::filesystem::exists(source / "scenes" / name) ? source / "scenes" : shared);
  TriangleMesh mesh = load_mesh(description.file, description.options);
  SensorPose start;
  start.position_m = description.start_m.value() - mesh.origin_in_file_m;
  start.pan_rad = description.start_pan_rad.value_or(0.0);
  return {name, Scene(std::move(mesh)), start};
}

MapWindow window_around(const TriangleMesh& mesh, double voxel_size_m) {
  constexpr int kMargin = 3;
  const VoxelGrid grid{voxel_size_m};
  const Eigen::AlignedBox3d bounds = mesh.bounds_m();
  const VoxelIndex min = grid.voxel_of(bounds.min()) - VoxelIndex::Constant(kMargin);
  const VoxelIndex max = grid.voxel_of(bounds.max()) + VoxelIndex::Constant(kMargin);
  return {min, max - min + VoxelIndex::Ones()};
}

bool is_clear(const VoxelMap& map, const VoxelIndex& voxel, double clearance_m) {
  const int reach = static_cast<int>(std::ceil(clearance_m / map.grid().voxel_size_m));
  if (map.label(voxel) != Label::Empty) return false;
  for (int k = -reach; k <= reach; ++k) {
    for (int j = -reach; j <= reach; ++j) {
      for (int i = -reach; i <= reach; ++i) {
        const VoxelIndex step(i, j, k);
        if (step.squaredNorm() < reach * reach && map.label(voxel + step) == Label::Occupied) {
          return false;
        }
      }
    }
  }
  return true;
}

std::string size_name(double voxel_size_m) {
  return std::to_string(std::lround(voxel_size_m * 100.0)) + "cm";
}

RecoveredRoom::RecoveredRoom(double voxel_size_m)
    : scans_(scan_room()),
      builder_({voxel_size_m},
               window_around(load_bench_scene("columns").scene.mesh(), voxel_size_m)),
      builder_before_({voxel_size_m}, builder_.map().window()) {
  for (const RangeImage& image : scans_) {
    const FoldReport& report = builder_.fold(image);
    changed_slots_ = report.changed_slots;
    updated_surfaces_ = report.updated_surfaces;
    if (&image != &scans_.back()) builder_before_.fold(image);
  }
  positions_ = feasible_positions(map());
}

PredictionRaster RecoveredRoom::raster() {
  return prediction_raster(TiltedLineScan::paper(), RangeLimits());
}

std::string RecoveredRoom::description() const {
  const VoxelIndex size = map().window().size;
  std::string text = std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " +
                     std::to_string(size[2]) + " voxels, of which";
  constexpr std::array<const char*, kLabelCount> kNames = {"Unmarked", "Occluded", "OcclusionPlane",
                                                           "Empty", "Occupied"};
  const MapStatistics statistics = builder_.statistics();
  for (std::size_t label = 0; label < kLabelCount; ++label) {
    text += std::string(label == 0 ? " " : ", ") + std::to_string(statistics.voxels[label]) + " " +
            kNames[label];
  }
  return text + "; " + std::to_string(scans_.size()) + " scans of " + std::to_string(kScanColumns) +
         " x " + std::to_string(kScanRows) + " points; the last changes " +
         std::to_string(changed_slots_.size()) + " voxels";
}

const RecoveredRoom& recovered_room(double voxel_size_m) {
  static std::map<double, std::unique_ptr<RecoveredRoom>> rooms;
  std::unique_ptr<RecoveredRoom>& room = rooms[voxel_size_m];
  if (!room) room = std::make_unique<RecoveredRoom>(voxel_size_m);
  return *room;
}

}  // namespace nextview
