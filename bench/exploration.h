#pragma once

#include <cstdint>
#include <memory>

#include "bench/recovered_room.h"
#include "mapper/map_builder.h"
#include "planner/paper_strategy.h"
#include "planner/view_planner.h"

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

/// The strategy that is measured.
std::unique_ptr<Strategy> paper_strategy(const ExplorationParameters& parameters, int threads = 1);

/// What one view of an exploration cost; seconds of wall clock.
struct ViewCost {
  int view = 0;  ///< the view the decision was made after
  double fold_s = 0.0;
  double digest_s = 0.0;
  double field_s = 0.0;  ///< the space follows the map
  double decision_s = 0.0;
  int evaluations = 0;
  bool moved = false;  ///< a decision was found
};

/// Scans, folds, decides and goes there, view after view.
class Exploration {
 public:
  /// By the paper's strategy.
  Exploration(const BenchScene& scene, const ExplorationParameters& parameters);
  /// By any.
  Exploration(const BenchScene& scene, const ExplorationParameters& parameters,
              std::unique_ptr<Strategy> strategy);
  /// One view.
  ViewCost step();

  /// Carries the sensor to a random place of the known free space, looking where it looked: for
  /// when a simplex, which knows only its surroundings, finds nothing more there.
  void carry_elsewhere();

  ViewPlanner& planner() { return planner_; }
  MapBuilder& builder() { return planner_.builder(); }
  const SensorPose& pose() const { return pose_; }  ///< where the next view is taken from
  int views() const { return planner_.views(); }
  const RangeImage& image() const { return image_; }  ///< of the last view

 private:
  const BenchScene& scene_;
  ExplorationParameters parameters_;
  RayTable rays_;
  ViewPlanner planner_;
  SensorPose pose_;
  RangeImage image_;
};

}  // namespace nextview
