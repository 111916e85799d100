#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "mapper/map_builder.h"

namespace nextview {

/// Why a run ended. README lists the names; the first five are a success.
enum class StopReason {
  NothingLeft,     ///< from nowhere that can be reached anything new is to be seen
  NothingNew,      ///< P23 rule 1: no more unseen area is covered
  QualityReached,  ///< P23 rule 2: the same, and every voxel's quality is above the threshold
  NoImprovement,   ///< P23 rule 3: the same, and quality improves no more
  ViewLimit,       ///< as many views as asked for
  NoFeasibleGoal,  ///< no attempt gave a goal that the base accepted
  DigestMismatch,  ///< planner and mapper hold different maps
  NoAnswer,        ///< somebody did not answer, however often asked
  ProcessDied,     ///< a process of the run ended before the run did
  BusFailed,       ///< messages could be sent or received no more
  Interrupted,     ///< SIGINT, SIGTERM or SIGHUP
};

/// All reasons, in order.
std::span<const StopReason> all_stop_reasons();
/// The name a reason has in logs and tables, such as "nothing_new".
std::string_view to_string(StopReason reason);
/// The reason of that name, or nothing when there is none.
std::optional<StopReason> stop_reason_from_string(std::string_view name);
/// One sentence for people.
std::string_view describe(StopReason reason);

/// By what a run ends (P23). The numbers are the paper's, and travel on the bus.
enum class StopRule : std::int8_t {
  NothingNew = 1,     ///< no more unseen area is covered
  Quality = 2,        ///< the same, and every voxel's quality is above a threshold
  NoImprovement = 3,  ///< the same, and quality improves no more
};

/// All rules, in order.
std::span<const StopRule> all_stop_rules();
/// The name a rule has where people give it: nothing_new, quality, no_improvement.
std::string_view to_string(StopRule rule);
/// The rule of that name, or nothing when there is none.
std::optional<StopRule> stop_rule_from_string(std::string_view name);

/// When a run has recovered what it can (P23).
struct StopParameters {
  StopRule rule = StopRule::NothingNew;
  double quality_threshold = 0.8;  ///< rule 2: for every Occupied voxel's quality
  int stop_window_views = 15;      ///< "no more": over this many views ...
  double stop_new_area_m2 = 0.10;  ///< ... less newly Occupied area than this in all
  /// Rule 3: ... and over the same views the mean quality has risen by less than this.
  double stop_improvement = 0.002;

  /// @throws std::invalid_argument naming the parameter that cannot be
  void check() const;
};

/// What the rules need to know of a view that has been folded into the map.
struct ViewFacts {
  /// Voxels that became Occupied x the area of a voxel's face, m^2.
  double newly_occupied_area_m2 = 0.0;
  double min_quality = 0.0;   ///< over all Occupied voxels, 0..1, after the view
  double mean_quality = 0.0;  ///< likewise
};

/// The facts of a view from the mapper's counts.
ViewFacts view_facts(const FoldReport& report, const MapStatistics& after, double voxel_size_m);

/// Whether the rule ends the run after these views, the last one just folded; nothing when it goes
/// on. Every rule needs stop_window_views whole views after the first one, which is the scan at the
/// start and says nothing about the planner.
std::optional<StopReason> should_stop(std::span<const ViewFacts> views,
                                      const StopParameters& parameters);

}  // namespace nextview
