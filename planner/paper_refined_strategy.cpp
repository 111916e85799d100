#include "planner/paper_refined_strategy.h"

#include <utility>
#include <variant>
#include <vector>

#include "planner/prediction/panorama_view_predictor.h"
#include "planner/prediction/selective_view_predictor.h"
#include "planner/strategy_inputs.h"

namespace nextview {

namespace {

std::unique_ptr<ViewPredictor> predictor_for(const StrategyInputs& inputs,
                                             const std::vector<Orientation>& orientations,
                                             bool counts_surfaces) {
  if (inputs.subdivisions == 0) {
    return std::make_unique<SelectiveViewPredictor>(inputs.raster, inputs.voxel_size_m,
                                                    orientations, counts_surfaces, inputs.threads);
  }
  return std::make_unique<PanoramaViewPredictor>(inputs.raster, inputs.voxel_size_m, orientations,
                                                 counts_surfaces, inputs.threads);
}

}  // namespace

std::unique_ptr<Strategy> PaperRefinedStrategy::make(const StrategyInputs& inputs) {
  PlannerParameters search = inputs.search;
  const FaceRefinement& refinement = search.refinement.emplace(inputs.subdivisions);
  std::unique_ptr<ViewPredictor> predictor =
      predictor_for(inputs, refinement.orientations(), ask_for_surfaces(search.weights));
  auto coarse_predictor = std::make_unique<SelectiveViewPredictor>(
      inputs.coarse_raster, inputs.voxel_size_m, refinement.orientations(), false, inputs.threads);
  return std::make_unique<PaperRefinedStrategy>(search, inputs.stop, inputs.voxel_size_m,
                                                std::move(predictor), std::move(coarse_predictor));
}

NextView PaperRefinedStrategy::next_view(const Situation& situation) {
  NextView next = PaperStrategy::next_view(situation);
  if (Decision* decision = std::get_if<Decision>(&next)) decision->strategy = kFacts.name;
  return next;
}

}  // namespace nextview
