#pragma once

#include <span>
#include <string>
#include <string_view>

/// What is to be known of the strategies without making one: for options, the checks of messages
/// and help texts. Knows no message, no map and no strategy's header, so that everybody may include
/// it.
namespace nextview {

/// A strategy's name and what it brings for what a user leaves open.
struct StrategyFacts {
  std::string_view name;     ///< in options, messages and tables
  std::string_view summary;  ///< how it chooses views, in a few words for --help
  int views;                 ///< after which a run ends at the latest
  int views_with_quality;    ///< the same when quality is looked for, too
  int directions;            ///< orientations tried at every position
  /// It ends the run when no view shows more than planner_config_t's least_gain_m2. No view shows
  /// less than nothing, so with 0 such a run would never end by itself.
  bool ends_by_least_gain;
  /// It ends the run by planner_config_t's stop_rule (P23).
  bool ends_by_stop_rule = false;
  /// Its objective is the paper's fitness with planner_config_t's structure_weight and
  /// navigation_weight (P18).
  bool weighs_factors = false;
  /// With as many directions as its own, every move departs as the first one does, by
  /// planner_config_t's departure_m; otherwise by later_departure_m from the second on.
  bool departs_alike = false;
};

/// Of all strategies, in the order of planner/strategy_list.h.
std::span<const StrategyFacts> all_strategies();
/// Of the strategy of that name; null when there is none.
const StrategyFacts* find_strategy(std::string_view name);
/// What to say of such a name: "there is no strategy 'guess', only paper and surface".
std::string no_such_strategy(std::string_view name);

}  // namespace nextview
