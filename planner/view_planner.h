#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mapper/map_builder.h"
#include "planner/decision.h"
#include "planner/prediction/known_space.h"
#include "planner/strategy.h"

namespace nextview {

/// Plans the views of a run, without a bus: fold a range image, ask for the next view, and when the
/// robot cannot go there, refuse it and ask again.
///
///     ViewPlanner planner(grid, window, std::make_unique<PaperStrategy>(...), {});
///     for (;;) {
///       planner.fold(scan());                            // where the robot stands
///       const NextView& next = planner.next_view();
///       if (std::holds_alternative<Ending>(next)) break; // and why
///       go_to(std::get<Decision>(next));
///     }
///
/// It owns the map, all that is derived from it, and the strategy, so that they cannot get out of
/// step. The same images and refusals give the same views and digests.
class ViewPlanner {
 public:
  struct Parameters {
    std::int64_t seed = 1;
    int max_views = 60;  ///< the run ends with this many views if it has not before
    int threads = 1;     ///< of no influence on the results

    /// @throws std::invalid_argument naming the parameter that cannot be
    void check() const;
  };

  /// An all-Unmarked map.
  /// @throws std::invalid_argument as VoxelMap, KnownSpace and Parameters::check do
  ViewPlanner(const VoxelGrid& grid, const MapWindow& window, std::unique_ptr<Strategy> strategy,
              const Parameters& parameters);

  /// Folds the range image of the next view.
  /// @return what it changed; valid until the next fold
  /// @throws std::invalid_argument as MapBuilder::fold does, nothing being changed
  const FoldReport& fold(const RangeImage& image);

  /// The view to take next, or why the run ends; worked out when it is first asked for.
  /// @throws std::logic_error before the first fold
  const NextView& next_view();

  /// The robot cannot go where next_view() said: another attempt follows.
  /// @throws std::logic_error unless next_view() has given a decision
  void refuse();

  int views() const { return views_; }      ///< folded
  int attempt() const { return attempt_; }  ///< of the view that is next, from 1
  const SensorPose& present() const { return present_; }
  MapBuilder& builder() { return builder_; }  ///< for its digest; not to be folded into
  const MapBuilder& builder() const { return builder_; }
  const VoxelMap& map() const { return builder_.map(); }
  /// The map and what is derived from it, after all that has been folded.
  const KnownSpace& space();

 private:
  NextView decide();

  Parameters parameters_;
  MapBuilder builder_;
  std::unique_ptr<Strategy> strategy_;
  KnownSpace space_;
  const FoldReport* not_in_space_ = nullptr;  // the last fold, until space_ has followed it
  int views_ = 0;
  int attempt_ = 1;
  SensorPose present_;
  std::vector<SensorPose> refused_;
  std::optional<NextView> next_;
};

}  // namespace nextview
