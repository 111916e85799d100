#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "planner/clear_space.h"
#include "planner/face_refinement.h"
#include "planner/feasibility.h"
#include "planner/last_look.h"
#include "planner/prediction/view_predictor.h"
#include "planner/refused_places.h"
#include "planner/shortest_paths.h"
#include "planner/strategy.h"
#include "planner/strategy_facts.h"
#include "planner/termination.h"

namespace nextview {

/// How the next best view is looked for (P19-P22).
struct PlannerParameters {
  FactorWeights weights = default_weights();  ///< what the factors count in the fitness (eq. 4)
  double step_min_m = 0.3;  ///< distance of the initial simplex's vertices from the first ...
  double step_max_m = 3.0;  ///< ... is drawn from this range
  double fitness_tolerance = 0.01;  ///< the simplex stops when its fitness range falls below
  int max_evaluations = 70;         ///< or after this many positions
  FeasibilityParameters feasibility;
  /// In place of feasibility's departure_m at all moves but the first.
  double later_departure_m = FeasibilityParameters{}.departure_m;
  /// How the orientations are looked through at a position; without it, all the predictor's. The
  /// predictor has its orientations.
  std::optional<FaceRefinement> refinement = {};

  const FaceRefinement* refined_by() const { return refinement ? &*refinement : nullptr; }
  /// @throws std::invalid_argument naming the parameter that cannot be
  void check() const;
};

/// Decides the next best view by hill climbing over positions with a simplex (P21), at each
/// position over the predictor's orientations, all or as the refinement says (P20), as far as the
/// known map lets the robot go (P19): a position is feasible when a path leads there.
/// @param paths stand at the present position; all of them are found when one is asked for that is
///        not straight
/// @return nothing when no position is feasible; the voxels of refused goals are not
/// @throws std::invalid_argument for parameters that cannot be, or a predictor that does not count
///         the surfaces that a factor asks for
std::optional<Decision> decide_by_simplex(const Situation& situation, ShortestPaths& paths,
                                          ViewPredictor& predictor,
                                          const PlannerParameters& parameters);

/// The paper's method, section 5: the simplex, and the rules that end a run (P23). Before rule 1 or
/// 3 ends it, a good view is looked for from everywhere (LastLook), and the run goes on from the
/// best.
class PaperStrategy : public Strategy {
 public:
  static constexpr StrategyFacts kFacts{.name = "paper",
                                        .summary = "a hill climb from where the sensor is",
                                        .views = 60,
                                        .views_with_quality = 300,
                                        .directions = 20,
                                        .ends_by_least_gain = false,
                                        .ends_by_stop_rule = true,
                                        .weighs_factors = true,
                                        .departs_alike = true};
  static std::unique_ptr<Strategy> make(const StrategyInputs& inputs);

  /// @param voxel_size_m of the map, for areas
  /// @param coarse_predictor of the same orientations, for LastLook
  /// @throws std::invalid_argument for parameters that cannot be
  PaperStrategy(const PlannerParameters& search, const StopParameters& stop, double voxel_size_m,
                std::unique_ptr<ViewPredictor> predictor,
                std::unique_ptr<ViewPredictor> coarse_predictor);

  KnownSpace::Surfaces surfaces() const override;
  void view_folded(const FoldedView& folded) override;
  std::optional<Ending> ending() const override;
  NextView next_view(const Situation& situation) override;

 private:
  void follow_map(const VoxelMap& map);
  NextView decided(const Situation& situation);
  NextView last_look(const Situation& situation, StopReason otherwise);

  PlannerParameters search_;
  StopParameters stop_;
  double voxel_size_m_;
  std::unique_ptr<ViewPredictor> predictor_;
  std::unique_ptr<ViewPredictor> coarse_predictor_;
  std::vector<ViewFacts> views_;              // folded
  std::vector<std::uint32_t> changed_slots_;  // folded, not yet followed
  std::optional<ClearSpace> clear_;           // of the map's window
  RefusedPlaces refused_;
  ShortestPaths paths_;
  LastLook last_look_;
  std::vector<Eigen::Vector3d> way_m_;  // of the last decision
};

}  // namespace nextview
