#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "planner/shortest_paths.h"
#include "planner/strategy.h"
#include "planner/view_evaluator.h"

namespace nextview {

/// Looks for a good view from everywhere before a run ends. The rule that ends it (P23 rule 1)
/// looks back only, and a hill climb (P21) around only: in a finished room with an open door both
/// say that no more is covered, while a path leads to where much is unseen.
///
/// Asked are all voxels that a path leads to, in all orientations: every fourth along each axis,
/// and while none is good every second and then every one. The good ones are remembered, and as
/// long as one of them stays good no others are asked. So that a large building takes seconds, a
/// coarse predictor of some hundred rays a view says first which voxels are worth asking: those
/// where it finds a fitness above kWorthAsking, which leaves its error three standard deviations.
class LastLook {
 public:
  /// What a good view's fitness is above, of the areas alone. A view of nothing new has 0.5 (P16).
  static constexpr double kGoodFitness = 0.6;
  static constexpr double kWorthAsking = 0.52;

  struct View {
    VoxelIndex voxel;
    BestView best;
  };

  /// The best of the good views, those first that it was asked to go to the least often; nothing
  /// when no view that can be reached is good.
  /// @param paths all found; the voxels of refused goals are left out
  /// @param coarse with the orientations of the evaluator's; of both the factors do not count
  std::optional<View> best_view(const Situation& situation, const ShortestPaths& paths,
                                ViewEvaluator& coarse, ViewEvaluator& evaluator);

  /// Of the last call.
  const std::vector<View>& good() const { return good_; }
  std::size_t voxels_asked() const { return voxels_asked_; }  ///< coarsely or not

 private:
  int& times_chosen(const VoxelMap& map, const View& view) {
    return times_chosen_[{map.slot(view.voxel), view.best.orientation}];
  }

  std::vector<View> good_;
  std::size_t voxels_asked_ = 0;
  std::map<std::pair<std::size_t, std::size_t>, int> times_chosen_;  // by slot and orientation
};

}  // namespace nextview
