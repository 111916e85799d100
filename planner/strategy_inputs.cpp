#include "planner/strategy_inputs.h"

#include <stdexcept>

#include "planner/strategy_list.h"

namespace nextview {

std::unique_ptr<Strategy> make_strategy(std::string_view name, const StrategyInputs& inputs) {
  std::unique_ptr<Strategy> strategy = AllStrategies::make(name, inputs);
  if (strategy == nullptr) throw std::invalid_argument(no_such_strategy(name));
  return strategy;
}

}  // namespace nextview
