#pragma once

#include <Eigen/Core>
#include <span>
#include <unordered_map>
#include <vector>

#include "planner/face_refinement.h"
#include "planner/fitness.h"
#include "planner/prediction/known_space.h"
#include "planner/prediction/view_predictor.h"
#include "planner/shortest_paths.h"
#include "sensor/sensor_pose.h"

namespace nextview {

/// Evaluates poses in one state of the map: what their rays would meet -> counts -> factors ->
/// fitness (P15-P18), at every position exhaustively over the predictor's orientations or by
/// refinement of promising faces (P20). A position's fitness is that of its voxel, best over the
/// orientations, ties to the lowest index; a voxel is evaluated once, with the path to the first
/// position in it that is asked for.
///
/// In the voxel the sensor stands in, the orientation it has just scanned with is left out: the
/// same scan again would add nothing, whatever its fitness.
class ViewEvaluator {
 public:
  /// Space, predictor and paths must outlive this object and not change.
  /// @param paths from the present position; asked only when the weights ask for travel, and then
  ///        must have been found to what is evaluated
  /// @param refinement with the predictor's orientations, outlives this object; null: exhaustively
  ViewEvaluator(const KnownSpace& space, ViewPredictor& predictor, const FactorWeights& weights,
                const SensorPose& present, const ShortestPaths& paths,
                const FaceRefinement* refinement = nullptr);

  /// Evaluates positions inside the map's window, as far as they are not yet, all together.
  void evaluate(std::span<const Eigen::Vector3d> positions_m);

  /// At a position that has been evaluated.
  const BestView& at(const Eigen::Vector3d& position_m) const;

  /// Of one view from a position inside the map's window, whether it has been evaluated or not.
  Fitness of_view(const Eigen::Vector3d& position_m, std::size_t orientation);

  const std::vector<Orientation>& orientations() const { return predictor_.orientations(); }
  /// How many views have been predicted so far for evaluate().
  std::size_t views_evaluated() const { return views_evaluated_; }

 private:
  void evaluate_all(std::span<const VoxelIndex> voxels, std::span<const Travel> travels);
  Travel travel_to(const Eigen::Vector3d& position_m) const;
  BestView best_view(const VoxelIndex& voxel, const Travel& travel,
                     std::span<const ViewCounts> counts) const;
  BestView refined_view(const VoxelIndex& voxel, const Travel& travel);
  bool just_scanned(const Orientation& orientation) const;

  const KnownSpace& space_;
  ViewPredictor& predictor_;
  const ShortestPaths& paths_;
  const FaceRefinement* refinement_;
  FactorWeights weights_;
  VoxelIndex present_;
  Eigen::Vector3d present_direction_;
  std::vector<VoxelIndex> unknown_;  // and the ways to them and their counts, of one call
  std::vector<Travel> travels_;
  std::vector<ViewCounts> counts_;
  std::size_t views_evaluated_ = 0;
  std::unordered_map<std::size_t, BestView> known_;  // by slot
};

}  // namespace nextview
