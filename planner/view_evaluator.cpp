#include "planner/view_evaluator.h"

#include <algorithm>
#include <stdexcept>

namespace nextview {
namespace {

/// Orientations nearer to each other than this are the same view.
constexpr double kSameDirection = 1e-9;  // of 1 - cos

}  // namespace

ViewEvaluator::ViewEvaluator(const KnownSpace& space, ViewPredictor& predictor,
                             const FactorWeights& weights, const SensorPose& present,
                             const ShortestPaths& paths, const FaceRefinement* refinement)
    : space_(space),
      predictor_(predictor),
      paths_(paths),
      refinement_(refinement),
      weights_(weights),
      present_(space.map().grid().voxel_of(present.position_m)),
      present_direction_(viewing_direction(present.pan_rad, present.tilt_rad)) {
  if (refinement != nullptr && refinement->orientations().size() != orientations().size()) {
    throw std::invalid_argument("faces are refined with the orientations of all their levels");
  }
}

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
  if (refinement_ == nullptr) return evaluate_all(unknown_, travels_);
  for (std::size_t i = 0; i < unknown_.size(); ++i) {
    known_[map.slot(unknown_[i])] = refined_view(unknown_[i], travels_[i]);
  }
}

void ViewEvaluator::evaluate_all(std::span<const VoxelIndex> voxels,
                                 std::span<const Travel> travels) {
  const std::size_t views = orientations().size();
  counts_.resize(voxels.size() * views);
  predictor_.predict_all(space_, voxels, counts_);
  views_evaluated_ += counts_.size();
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    known_[space_.map().slot(voxels[i])] =
        best_view(voxels[i], travels[i], std::span(counts_).subspan(i * views, views));
  }
}

const BestView& ViewEvaluator::at(const Eigen::Vector3d& position_m) const {
  return known_.at(space_.map().slot(space_.map().grid().voxel_of(position_m)));
}

Fitness ViewEvaluator::of_view(const Eigen::Vector3d& position_m, std::size_t orientation) {
  predictor_.look_from(space_, space_.map().grid().voxel_of(position_m));
  ViewCounts counts;
  predictor_.count({&orientation, 1}, {&counts, 1});
  return fitness(counts, travel_to(position_m), weights_);
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

BestView ViewEvaluator::refined_view(const VoxelIndex& voxel, const Travel& travel) {
  predictor_.look_from(space_, voxel);
  const auto evaluate = [&](std::span<const std::size_t> which, std::span<Fitness> values) {
    counts_.resize(which.size());
    predictor_.count(which, counts_);
    views_evaluated_ += which.size();
    std::ranges::transform(counts_, values.begin(), [&](const ViewCounts& counts) {
      return fitness(counts, travel, weights_);
    });
  };
  const auto may_be_chosen = [&](std::size_t orientation) {
    return voxel != present_ || !just_scanned(orientations()[orientation]);
  };
  return refinement_->best_view(evaluate, may_be_chosen, weights_);
}

bool ViewEvaluator::just_scanned(const Orientation& orientation) const {
  return orientation.direction.dot(present_direction_) > 1.0 - kSameDirection;
}

}  // namespace nextview
