#pragma once

#include <string>
#include <vector>

#include "mapper/map_builder.h"
#include "planner/prediction/view_predictor.h"
#include "scene/scene.h"
#include "sensor/range_image.h"

namespace nextview {

/// One of the project's rooms or one of the models in ../shared/scenes, and where a run starts.
struct BenchScene {
  std::string name;
  Scene scene;
  SensorPose start;
};

/// @throws SceneError when there is no such scene, as on a machine without ../shared/scenes
BenchScene load_bench_scene(const std::string& name);

/// A window of voxels around a scene, a few more on every side.
MapWindow window_around(const TriangleMesh& mesh, double voxel_size_m);

/// Whether a voxel is Empty and no Occupied one is nearer to it than a length.
bool is_clear(const VoxelMap& map, const VoxelIndex& voxel, double clearance_m);

/// A voxel size as it stands in the names of benchmarks: 5cm.
std::string size_name(double voxel_size_m);

/// The room most figures are measured in: the paper's second one, 6 x 4.5 x 3 m with three columns,
/// recovered in part by scans of 512 x 256 points. The scans leave shadows behind the columns and
/// corners nobody looked into, so that rays meet every label.
class RecoveredRoom {
 public:
  explicit RecoveredRoom(double voxel_size_m);

  double voxel_size_m() const { return map().grid().voxel_size_m; }
  const std::vector<RangeImage>& scans() const { return scans_; }
  /// After all scans.
  const VoxelMap& map() const { return builder_.map(); }
  /// After all scans but the last, whose fold changed these slots of the map above.
  const VoxelMap& map_before_last_scan() const { return builder_before_.map(); }
  const std::vector<std::uint32_t>& changed_by_last_scan() const { return changed_slots_; }
  const std::vector<std::uint32_t>& surfaces_of_last_scan() const { return updated_surfaces_; }

  /// Sixty feasible sensor positions (P19: Empty, 0.40 m from everything Occupied), about what one
  /// decision asks for.
  const std::vector<VoxelIndex>& positions() const { return positions_; }
  /// What the sensor's own 64 x 30 rays are.
  static PredictionRaster raster();
  /// How many voxels have which label, for the conditions.
  std::string description() const;

 private:
  std::vector<RangeImage> scans_;
  MapBuilder builder_;
  MapBuilder builder_before_;
  std::vector<std::uint32_t> changed_slots_;
  std::vector<std::uint32_t> updated_surfaces_;
  std::vector<VoxelIndex> positions_;
};

/// The room at a voxel size, made when first asked for and kept.
const RecoveredRoom& recovered_room(double voxel_size_m);

}  // namespace nextview
