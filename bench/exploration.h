#pragma once

#include <cstdint>
#include <vector>

#include "bench/recovered_room.h"
#include "mapper/map_builder.h"
#include "planner/next_view.h"

namespace nextview {

/// How a scene is explored in one process, without a bus.
struct ExplorationParameters {
  double voxel_size_m = 0.10;
  int views = 30;
  TiltedLineScan sensor = TiltedLineScan::paper();
  PlannerParameters planner = {};
  std::int64_t seed = 1;
};

/// A sensor as fine as the voxels ask for: the paper's 64 x 30 rays at 10 cm, more at 5 and 2 cm.
TiltedLineScan sensor_for(double voxel_size_m);

/// What one view of an exploration cost; seconds of wall clock.
struct ViewCost {
  int view = 0;  ///< the view the decision was made after
  double fold_s = 0.0;
  double digest_s = 0.0;
  double field_s = 0.0;     ///< ViewPredictor::map_changed
  double decision_s = 0.0;  ///< decide_next_view
  int evaluations = 0;
  bool moved = false;  ///< a decision was found
};

/// Scans, folds, decides and goes there, view after view.
class Exploration {
 public:
  Exploration(const BenchScene& scene, const ExplorationParameters& parameters);
  /// One view.
  ViewCost step(ViewPredictor& predictor);

  /// Carries the sensor to a random place of the known free space, looking where it looked: for
  /// when a simplex, which knows only its surroundings, finds nothing more there.
  void carry_elsewhere();

  MapBuilder& builder() { return builder_; }
  const SensorPose& pose() const { return pose_; }  ///< where the next view is taken from
  int views() const { return view_; }
  const RangeImage& image() const { return image_; }  ///< of the last view

 private:
  const BenchScene& scene_;
  ExplorationParameters parameters_;
  RayTable rays_;
  MapBuilder builder_;
  SensorPose pose_;
  RangeImage image_;
  int view_ = 0;
};

}  // namespace nextview
