#include "planner/view_evaluator.h"

namespace nextview {
namespace {

/// Orientations nearer to each other than this are the same view.
constexpr double kSameDirection = 1e-9;  // of 1 - cos

}  // namespace

ViewEvaluator::ViewEvaluator(const KnownSpace& space, ViewPredictor& predictor,
                             const FactorWeights& weights, const SensorPose& present,
                             const ShortestPaths& paths)
    : space_(space),
      predictor_(predictor),
      paths_(paths),
      weights_(weights),
      present_(space.map().grid().voxel_of(present.position_m)),
      present_direction_(viewing_direction(present.pan_rad, present.tilt_rad)) {}

void ViewEvaluator::evaluate(std::span<const Eigen::Vector3d> positions_m) {
  const VoxelMap& map = space_.map();
  unknown_.clear();
  travels_.clear();
  for (const Eigen::Vector3d& position_m : positions_m) {
    const VoxelIndex voxel = map.grid().voxel_of(position_m);
    if (!known_.try_emplace(map.slot(voxel)).second) continue;
    unknown_.push_back(voxel);
    travels_.push_back(travel_to(position_m));
  }
  const std::size_t views = orientations().size();
  counts_.resize(unknown_.size() * views);
  predictor_.predict_all(space_, unknown_, counts_);
  for (std::size_t i = 0; i < unknown_.size(); ++i) {
    known_[map.slot(unknown_[i])] =
        best_view(unknown_[i], travels_[i], std::span(counts_).subspan(i * views, views));
  }
}

const BestView& ViewEvaluator::at(const Eigen::Vector3d& position_m) const {
  return known_.at(space_.map().slot(space_.map().grid().voxel_of(position_m)));
}

Fitness ViewEvaluator::of_view(const Eigen::Vector3d& position_m, std::size_t orientation) {
  counts_.resize(orientations().size());
  predictor_.predict(space_, space_.map().grid().voxel_of(position_m), counts_);
  return fitness(counts_[orientation], travel_to(position_m), weights_);
}

Travel ViewEvaluator::travel_to(const Eigen::Vector3d& position_m) const {
  if (!ask_for_travel(weights_)) return {};
  return travel_along(paths_.waypoints_to_m(position_m));
}

BestView ViewEvaluator::best_view(const VoxelIndex& voxel, const Travel& travel,
                                  std::span<const ViewCounts> counts) const {
  BestView best;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (voxel == present_ && just_scanned(orientations()[i])) continue;
    const Fitness candidate = fitness(counts[i], travel, weights_);
    if (!best.any || candidate.value > best.fitness.value) best = {i, candidate, true};
  }
  return best;
}

bool ViewEvaluator::just_scanned(const Orientation& orientation) const {
  return orientation.direction.dot(present_direction_) > 1.0 - kSameDirection;
}

}  // namespace nextview
