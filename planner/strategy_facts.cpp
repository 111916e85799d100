#include "planner/strategy_facts.h"

#include <fmt/format.h>

#include <algorithm>

#include "planner/strategy_list.h"

namespace nextview {

std::span<const StrategyFacts> all_strategies() { return AllStrategies::kFacts; }

const StrategyFacts* find_strategy(std::string_view name) {
  const auto found = std::ranges::find(AllStrategies::kFacts, name, &StrategyFacts::name);
  return found == AllStrategies::kFacts.end() ? nullptr : &*found;
}

std::string no_such_strategy(std::string_view name) {
  std::string names;
  for (const StrategyFacts& each : all_strategies()) {
    const bool last = &each == &all_strategies().back();
    names += (names.empty() ? "" : last ? " and " : ", ") + std::string(each.name);
  }
  return fmt::format("there is no strategy '{}', only {}", name, names);
}

}  // namespace nextview
