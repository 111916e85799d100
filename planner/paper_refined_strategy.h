#pragma once

#include <memory>

#include "planner/paper_strategy.h"
#include "planner/strategy.h"
#include "planner/strategy_facts.h"

namespace nextview {

/// The paper's method with the refinement of orientations it speaks of (P20): as PaperStrategy, but
/// among many orientations, of which at each position only those are tried that lie in promising
/// faces (FaceRefinement). As there, more than 20 are predicted by one panorama; the sensor's own
/// rays take 4 to 17 times as long (docs/experiments.md).
class PaperRefinedStrategy : public PaperStrategy {
 public:
  static constexpr StrategyFacts kFacts{.name = "paper_refined",
                                        .summary = "as paper, and promising directions refined",
                                        .views = 60,
                                        .views_with_quality = 300,
                                        .directions = 320,
                                        .ends_by_least_gain = false,
                                        .ends_by_stop_rule = true,
                                        .weighs_factors = true};
  static std::unique_ptr<Strategy> make(const StrategyInputs& inputs);

  using PaperStrategy::PaperStrategy;

  NextView next_view(const Situation& situation) override;
};

}  // namespace nextview
