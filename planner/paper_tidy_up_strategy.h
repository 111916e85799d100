#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "planner/clear_space.h"
#include "planner/hole_views.h"
#include "planner/prediction/view_predictor.h"
#include "planner/refused_places.h"
#include "planner/shortest_paths.h"
#include "planner/strategy.h"
#include "planner/strategy_facts.h"
#include "planner/surface_holes.h"
#include "planner/termination.h"

namespace nextview {

/// When the holes of the surface are looked for, and how.
struct TidyUpParameters {
  /// The simplex gives way when the area its last views have newly covered is, a view, less than
  /// this share of what a view has covered on the mean ...
  double fallen_yield = 0.5;
  int yield_views = 5;           ///< ... over so many views
  double largest_hole_m = 1.0;   ///< larger ones are looked into in parts
  HoleViewParameters view = {};  ///< with the field and the range of the sensor
  FeasibilityParameters feasibility = {};

  /// @throws std::invalid_argument naming the parameter that cannot be
  void check() const;
};

/// Whether the simplex's yield has fallen after these views, the last one just folded. The scan at
/// the start does not count.
bool yield_has_fallen(std::span<const ViewFacts> views, const TidyUpParameters& parameters);

/// The paper's method with the tidying up it proposes (P24): the simplex, until its yield has
/// fallen or no more unseen area is covered (P23 rule 1); then a view into every hole of the
/// surface that can be looked into, the one that shows most for the way there first.
///
/// A voxel that a view was to show and did not is trusted half as much afterwards, and after
/// kMostInVain such views it is left. When there is no hole left, rule 1 ends the run; under the
/// other rules the simplex goes on for quality.
class PaperTidyUpStrategy : public Strategy {
 public:
  static constexpr StrategyFacts kFacts{.name = "paper_tidy_up",
                                        .summary =
                                            "as paper until that finds little, then by a view into "
                                            "every hole of the surface, until none is left",
                                        .views = 1000,
                                        .views_with_quality = 1000,
                                        .directions = 20,
                                        .ends_by_least_gain = false,
                                        .ends_by_stop_rule = true,
                                        .weighs_factors = true};
  static std::unique_ptr<Strategy> make(const StrategyInputs& inputs);

  static constexpr int kMostInVain = 3;

  /// @param simplex the paper's strategy
  /// @param raster the rays a view's fitness is told by
  /// @param voxel_size_m of the map
  /// @throws std::invalid_argument for parameters that cannot be
  PaperTidyUpStrategy(std::unique_ptr<Strategy> simplex, const StopParameters& stop,
                      const TidyUpParameters& tidy_up, const PredictionRaster& raster,
                      double voxel_size_m);

  KnownSpace::Surfaces surfaces() const override { return simplex_->surfaces(); }
  void view_folded(const FoldedView& folded) override;
  std::optional<Ending> ending() const override { return simplex_->ending(); }
  NextView next_view(const Situation& situation) override;

 private:
  enum class Phase { Simplex, TidyingUp, TidiedUp };

  NextView by_simplex(const Situation& situation);
  std::optional<Decision> tidy_up(const Situation& situation);
  void follow_map(const Situation& situation);
  void doubt_what_was_not_seen(const VoxelMap& map);
  std::vector<SurfaceHole> trusted_holes(const VoxelMap& map) const;
  Decision decision(const Situation& situation, const std::vector<HoleView>& views);
  NextView nothing_left(const Situation& situation);

  std::unique_ptr<Strategy> simplex_;
  StopParameters stop_;
  TidyUpParameters parameters_;
  PredictionRaster raster_;
  double voxel_size_m_;
  Phase phase_ = Phase::Simplex;
  std::vector<ViewFacts> views_;              // folded
  std::vector<std::uint32_t> changed_slots_;  // folded, not yet followed
  std::optional<ClearSpace> clear_;           // from when tidying up begins
  RefusedPlaces refused_;
  ShortestPaths paths_;
  std::vector<Eigen::Vector3d> way_m_;            // of the last decision
  std::vector<std::uint32_t> aimed_at_;           // slots the view under way is to show
  std::unordered_map<std::size_t, int> in_vain_;  // by slot: views that were to show it
  int followed_view_ = 0;
};

}  // namespace nextview
