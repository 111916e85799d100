#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "planner/clear_space.h"
#include "planner/prediction/grown_surface.h"
#include "planner/prediction/surface_gain.h"
#include "planner/refused_places.h"
#include "planner/shortest_paths.h"
#include "planner/strategy.h"
#include "planner/strategy_facts.h"
#include "planner/unseen_boundary.h"
#include "planner/view_candidates.h"

namespace nextview {

/// How surfaces are looked for; docs/strategy.md says what each of them is worth.
struct SurfaceParameters {
  double path_cost_per_m = 0.12;    ///< lambda; 0: fewest views, whatever the way
  double unknown_weight = 0.3;      ///< of unknown voxels beside those of grown planes
  bool grow_planes = true;          ///< without them unknown voxels should weigh 1
  double improvement_weight = 0.0;  ///< of quality; 0: it does not count
  double min_overlap = 0.2;         ///< of a view with what is known
  double least_new_area_m2 = 0.05;  ///< the run ends when no view is expected to show more
  double first_departure_m = 1.0;   ///< of the first move (FeasibilityParameters::departure_m)
  double departure_m = 0.3;         ///< of all others
  bool return_home = false;         ///< to the first view's pose, when nothing is left
  int spacing_voxels = 3;           ///< between candidate positions
  FeasibilityParameters feasibility;

  /// @throws std::invalid_argument naming the parameter that cannot be
  void check() const;
};

/// Goes where most new surface is to be seen for the way there: over all positions that a path
/// through known free space leads to, and all orientations, the view of the largest
///
///     value exp(-lambda path),   value = new voxels of surface (surface_gain.h)
///
/// A voxel that a view was to show and did not is trusted half as much afterwards. The run ends
/// when no view from anywhere it can get to is expected to show anything new.
class SurfaceStrategy : public Strategy {
 public:
  static constexpr StrategyFacts kFacts{.name = "surface",
                                        .summary =
                                            "by the new surface to be seen from anywhere it can "
                                            "get to, until nothing is left",
                                        .views = 1000,
                                        .views_with_quality = 1000,
                                        .directions = 320,
                                        .ends_by_least_gain = true};
  static std::unique_ptr<Strategy> make(const StrategyInputs& inputs);

  /// @param voxel_size_m of the map
  /// @throws std::invalid_argument for parameters that cannot be
  SurfaceStrategy(const PredictionRaster& raster, double voxel_size_m,
                  std::vector<Orientation> orientations, const SurfaceParameters& parameters);

  KnownSpace::Surfaces surfaces() const override;
  void view_folded(const FoldedView& folded) override;
  std::optional<Ending> ending() const override { return std::nullopt; }
  NextView next_view(const Situation& situation) override;

  /// What was left unseen when next_view() gave NothingLeft; nothing before.
  const std::optional<UnseenBoundary>& left_unseen() const { return left_unseen_; }

 private:
  void follow_map(const KnownSpace& space, int view);
  void begin_with(const KnownSpace& space);
  void doubt_what_was_not_seen(const KnownSpace& space);
  void take_refusal(const Situation& situation);
  SurfaceGain::Known known(const KnownSpace& space) const;
  PositionLattice enough_positions(const Situation& situation) const;
  CandidateView refined(const SurfaceGain::Known& known, CandidateView candidate);
  std::vector<CandidateView> best_views(const SurfaceGain::Known& known,
                                        std::span<const VoxelIndex> positions);
  Decision decision(const SurfaceGain::Known& known, std::span<const CandidateView> best,
                    std::size_t positions);
  std::string in_words(std::span<const CandidateView> best, std::size_t positions) const;
  NextView nothing_left(const Situation& situation, std::size_t positions);
  double area_m2(double voxels) const { return voxels * voxel_size_m_ * voxel_size_m_; }

  SurfaceParameters parameters_;
  double voxel_size_m_;
  double range_max_m_;
  SurfaceGain gain_;
  ViewCandidates candidates_;
  std::optional<ClearSpace> clear_;  // of the map's window
  std::optional<GrownSurface> grown_;
  ShortestPaths paths_;
  LazyArray<std::uint8_t> in_vain_;           // by offset of the field
  std::vector<std::uint32_t> aimed_at_;       // offsets the view under way is to show
  std::vector<std::uint32_t> changed_slots_;  // folded, not yet followed
  std::vector<std::uint32_t> updated_surfaces_;
  std::vector<Eigen::Vector3d> way_;  // of the last decision
  RefusedPlaces refused_;
  std::optional<SensorPose> home_;
  std::optional<UnseenBoundary> left_unseen_;
  int followed_view_ = 0;
};

}  // namespace nextview
