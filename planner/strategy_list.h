#pragma once

#include <array>
#include <memory>
#include <string_view>

#include "planner/paper_refined_strategy.h"
#include "planner/paper_strategy.h"
#include "planner/paper_tidy_up_strategy.h"
#include "planner/strategy.h"
#include "planner/strategy_facts.h"
#include "planner/surface_strategy.h"

namespace nextview {

/// Strategies as types. Each has, beside what Strategy asks for,
///
///     static constexpr StrategyFacts kFacts;
///     static std::unique_ptr<Strategy> make(const StrategyInputs& inputs);
template <class... Each>
struct StrategyTypes {
  static constexpr std::array<StrategyFacts, sizeof...(Each)> kFacts{Each::kFacts...};

  /// Null when none has that name.
  static std::unique_ptr<Strategy> make(std::string_view name, const StrategyInputs& inputs) {
    std::unique_ptr<Strategy> made;
    ((Each::kFacts.name == name ? void(made = Each::make(inputs)) : void()), ...);
    return made;
  }
};

/// All strategies there are. A new one is a file of its own and a line here: options, help, the
/// checks of messages and the planner go by this list.
// clang-format off
using AllStrategies = StrategyTypes<
    PaperStrategy,
    PaperRefinedStrategy,
    PaperTidyUpStrategy,
    SurfaceStrategy
>;
// clang-format on

}  // namespace nextview
