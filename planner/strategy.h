#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "mapper/map_builder.h"
#include "planner/decision.h"
#include "planner/prediction/known_space.h"
#include "sensor/sensor_pose.h"

namespace nextview {

struct StrategyInputs;

/// What a view is decided on.
struct Situation {
  const KnownSpace& space;  ///< with all range images so far folded in
  SensorPose present;       ///< the last one's pose
  std::int64_t seed;        ///< of the run; with view and attempt it seeds what is drawn
  int view;                 ///< to decide on, from 2
  int attempt;              ///< from 1
  /// Goals of this view that the base has refused, in order; attempt - 1 of them.
  std::span<const SensorPose> refused;
};

/// What a range image has changed.
struct FoldedView {
  int view;                         ///< from 1
  SensorPose pose;                  ///< from which it was really taken
  const FoldReport& report;         ///< the slots it changed
  const MapStatistics& statistics;  ///< of the map after it
};

/// Chooses views. A run has one strategy, which may remember what it has seen, but nothing else:
/// given the same views and the same situations it decides the same, whatever the machine, the time
/// or the number of threads. A new strategy is a file of its own and a line in the list of them
/// (strategy_list.h), which says what it has besides.
class Strategy {
 public:
  virtual ~Strategy() = default;

  /// What the space it is given has to keep.
  virtual KnownSpace::Surfaces surfaces() const = 0;
  /// Called once after every range image, in the order of views, before anything is decided on it.
  virtual void view_folded(const FoldedView& folded) = 0;
  /// Whether the run is over with the views folded so far; asked before a view's first attempt.
  virtual std::optional<Ending> ending() const = 0;
  /// The next view, or why there is none.
  /// @throws std::invalid_argument when the present position lies outside the map's window
  virtual NextView next_view(const Situation& situation) = 0;
};

}  // namespace nextview
