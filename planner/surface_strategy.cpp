#include "planner/surface_strategy.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "lcmtypes/parameter_bounds.h"
#include "planner/strategy_inputs.h"

namespace nextview {

namespace {

/// With fewer positions than this their spacing is halved.
constexpr std::size_t kFewPositions = 40;
// Of what no message and no option says.
constexpr Bounds kUnknownWeight{"unknown_weight", 0.0, 1.0};
constexpr Bounds kImprovementWeight{"improvement_weight", 0.0, 10.0};
constexpr Bounds kSpacing{"spacing_voxels", 1, 1000};
/// So many positions are refined.
constexpr std::size_t kRefined = 4;

bool is_unknown(std::uint8_t byte) {
  return byte == FreeSpaceField::kUnseen || byte == FreeSpaceField::kOcclusionPlane;
}

SurfaceGain::Parameters gain_parameters(const SurfaceParameters& parameters) {
  return {parameters.grow_planes ? parameters.unknown_weight : 1.0, parameters.improvement_weight,
          parameters.min_overlap};
}

}  // namespace

void SurfaceParameters::check() const {
  bounds::kPathCost.require(path_cost_per_m);
  kUnknownWeight.require(unknown_weight);
  kImprovementWeight.require(improvement_weight);
  bounds::kLeastOverlap.as("min_overlap").require(min_overlap);
  bounds::kLeastGain.as("least_new_area_m2").require(least_new_area_m2);
  bounds::kDeparture.as("first_departure_m").require(first_departure_m);
  bounds::kDeparture.require(departure_m);
  kSpacing.require(spacing_voxels);
  feasibility.check();
}

SurfaceStrategy::SurfaceStrategy(const PredictionRaster& raster, double voxel_size_m,
                                 std::vector<Orientation> orientations,
                                 const SurfaceParameters& parameters)
    : parameters_((parameters.check(), parameters)),
      voxel_size_m_(voxel_size_m),
      range_max_m_(raster.range_max_m),
      gain_(raster, voxel_size_m, std::move(orientations), gain_parameters(parameters)),
      candidates_(gain_, parameters.path_cost_per_m) {}

std::unique_ptr<Strategy> SurfaceStrategy::make(const StrategyInputs& inputs) {
  return std::make_unique<SurfaceStrategy>(inputs.raster, inputs.voxel_size_m, inputs.orientations,
                                           inputs.surface);
}

KnownSpace::Surfaces SurfaceStrategy::surfaces() const {
  return parameters_.improvement_weight > 0.0 ? KnownSpace::Surfaces::Keep
                                              : KnownSpace::Surfaces::Leave;
}

void SurfaceStrategy::view_folded(const FoldedView& folded) {
  const auto append = [](std::vector<std::uint32_t>& to, const std::vector<std::uint32_t>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(changed_slots_, folded.report.changed_slots);
  append(updated_surfaces_, folded.report.updated_surfaces);
  if (!home_) home_ = folded.pose;
}

SurfaceGain::Known SurfaceStrategy::known(const KnownSpace& space) const {
  return {space.field(), in_vain_, grown_ ? &*grown_ : nullptr,
          space.keeps_surfaces() ? &space.surfaces() : nullptr};
}

void SurfaceStrategy::begin_with(const KnownSpace& space) {
  clear_.emplace(space.map(), parameters_.feasibility);
  if (parameters_.grow_planes) grown_.emplace(space.map());
  in_vain_ = LazyArray<std::uint8_t>(space.field().size());
  aimed_at_.clear();
  refused_.clear();
  candidates_.begin_with(known(space));
}

void SurfaceStrategy::follow_map(const KnownSpace& space, int view) {
  if (followed_view_ == view) return;
  followed_view_ = view;
  const VoxelMap& map = space.map();
  std::vector<std::uint32_t> changed;
  if (!clear_ || clear_->window() != map.window()) {
    begin_with(space);
  } else {
    changed = clear_->update(map, changed_slots_);
    if (grown_) grown_->update(map, changed);
  }
  candidates_.begin_view(view);
  const auto note = [&](std::span<const std::uint32_t> slots) {
    std::vector<std::uint32_t> offsets;
    for (const std::uint32_t slot : slots) {
      offsets.push_back(static_cast<std::uint32_t>(space.field().offset(map.index_of_slot(slot))));
    }
    candidates_.offsets_changed(known(space), offsets);
  };
  note(changed);
  if (grown_) note(grown_->changed());
  if (space.keeps_surfaces()) note(updated_surfaces_);
  changed_slots_.clear();
  updated_surfaces_.clear();
  doubt_what_was_not_seen(space);
  refused_.forget_near(*clear_, map, changed);
}

void SurfaceStrategy::doubt_what_was_not_seen(const KnownSpace& space) {
  std::vector<std::uint32_t> doubted;
  for (const std::uint32_t offset : aimed_at_) {
    if (!is_unknown(space.field().bytes()[offset])) continue;
    if (in_vain_[offset] < 255) ++in_vain_[offset];
    doubted.push_back(offset);
  }
  candidates_.offsets_changed(known(space), doubted);
  aimed_at_.clear();
}

void SurfaceStrategy::take_refusal(const Situation& situation) {
  if (situation.refused.empty()) return;
  aimed_at_.clear();  // nobody went there
  refused_.add(*clear_, way_, situation.refused.size());
}

PositionLattice SurfaceStrategy::enough_positions(const Situation& situation) const {
  const VoxelIndex present = clear_->grid().voxel_of(situation.present.position_m);
  for (int spacing = parameters_.spacing_voxels;; spacing /= 2) {
    // The seed moves the lattice: runs differ in nothing else.
    const auto phase = [&](int axis) {
      return static_cast<int>(situation.seed >> (2 * axis) & 3) % spacing;
    };
    PositionLattice lattice(paths_, present, {phase(0), phase(1), phase(2)}, spacing);
    if (lattice.voxels.size() >= kFewPositions || spacing == 1) return lattice;
  }
}

CandidateView SurfaceStrategy::refined(const SurfaceGain::Known& known, CandidateView candidate) {
  for (const int step : {2, 1}) {
    const VoxelIndex around = candidate.voxel;
    for (int axis = 0; axis < 3; ++axis) {
      for (const int sign : {-1, 1}) {
        VoxelIndex voxel = around;
        voxel[axis] += sign * step;
        if (paths_.length_m(voxel) == ShortestPaths::kUnreachable) continue;
        const CandidateView other = candidates_.judge(known, paths_, voxel);
        if (other.score > candidate.score) candidate = other;
      }
    }
  }
  return candidate;
}

std::vector<CandidateView> SurfaceStrategy::best_views(const SurfaceGain::Known& known,
                                                       std::span<const VoxelIndex> positions) {
  std::vector<CandidateView> best = candidates_.best(known, paths_, positions, kRefined);
  for (CandidateView& candidate : best) candidate = refined(known, candidate);
  std::ranges::stable_sort(best, std::ranges::greater(), &CandidateView::score);
  return best;
}

NextView SurfaceStrategy::next_view(const Situation& situation) {
  follow_map(situation.space, situation.view);
  take_refusal(situation);
  const bool first_move = situation.view == 2;
  paths_.find(*clear_, situation.space.map(), situation.present.position_m,
              first_move ? parameters_.first_departure_m : parameters_.departure_m);
  const SurfaceGain::Known known = this->known(situation.space);
  const PositionLattice lattice = enough_positions(situation);
  std::vector<CandidateView> best = best_views(known, lattice.voxels);
  const auto is_worth = [&](const CandidateView& candidate) {
    return area_m2(candidate.value) >= parameters_.least_new_area_m2;
  };
  if (best.empty() || !is_worth(best.front())) {
    // What is far may still be worth the way, and so may what lies between.
    CandidateView most = candidates_.most_valuable(known, paths_, lattice.voxels);
    if (!is_worth(most)) {
      const double least = parameters_.least_new_area_m2 / area_m2(1.0);
      const auto between = candidates_.off_lattice(known, paths_, lattice, least);
      if (!between) return nothing_left(situation, paths_.reached().size());
      most = *between;
    }
    best = {refined(known, most)};
  }
  return decision(known, best, lattice.voxels.size());
}

Decision SurfaceStrategy::decision(const SurfaceGain::Known& known,
                                   std::span<const CandidateView> best, std::size_t positions) {
  const CandidateView& chosen = best.front();
  const Orientation& orientation = gain_.orientations()[chosen.view.orientation];
  gain_.look_from(known, chosen.voxel);
  aimed_at_ = gain_.aimed_at(chosen.view.orientation);
  way_ = paths_.waypoints_m(chosen.voxel);

  Decision decision;
  decision.waypoints_m = way_;
  decision.pose = {way_.back(), orientation.pan_rad, orientation.tilt_rad};
  decision.fitness = fitness(gain_.counts(known, chosen.view.orientation));
  decision.strategy = kFacts.name;
  decision.expected_gain_m2 = area_m2(chosen.view.new_voxels);
  decision.overlap = chosen.view.overlap;
  decision.reason = in_words(best, positions);
  for (const CandidateView& tried : candidates_.judged()) {
    if (decision.tried.size() == Decision::kMostTried) break;
    const Orientation& direction = gain_.orientations()[tried.view.orientation];
    decision.tried.push_back({clear_->grid().center_m(tried.voxel), direction.pan_rad,
                              direction.tilt_rad, tried.score / std::max(chosen.score, 1e-9)});
  }
  decision.evaluations = static_cast<int>(candidates_.judged().size());
  return decision;
}

std::string SurfaceStrategy::in_words(std::span<const CandidateView> best,
                                      std::size_t positions) const {
  const auto expects = [&](const CandidateView& candidate) {
    std::string words = fmt::format("{:.2f} m2 of new surface, {:.1f} m away",
                                    area_m2(candidate.view.new_voxels), candidate.path_m);
    if (candidate.view.improvement > 0.0) {
      words += fmt::format(", and {:.2f} m2 seen better", area_m2(candidate.view.improvement));
    }
    return words;
  };
  std::string words = "expects " + expects(best.front());
  if (best.size() > 1) words += "; second came " + expects(best[1]);
  return words + "; " + std::to_string(candidates_.judged().size()) + " of " +
         std::to_string(positions) + " positions looked from";
}

NextView SurfaceStrategy::nothing_left(const Situation& situation, std::size_t positions) {
  const VoxelMap& map = situation.space.map();
  const VoxelIndex home = map.grid().voxel_of(home_->position_m);
  const bool at_home = map.grid().voxel_of(situation.present.position_m) == home;
  const bool can_go_home = paths_.length_m(home) != ShortestPaths::kUnreachable;
  if (parameters_.return_home && !at_home && can_go_home) {
    Decision decision;
    way_ = paths_.waypoints_m(home);
    way_.back() = home_->position_m;
    decision.waypoints_m = way_;
    decision.pose = *home_;
    decision.strategy = kFacts.name;
    decision.reason = "nothing is left to see: home";
    return decision;
  }
  left_unseen_ = unseen_boundary(map, *clear_, paths_, range_max_m_);
  return Ending{
      StopReason::NothingLeft,
      fmt::format("From none of {} positions is more than {:.2f} m2 of new surface expected; {}",
                  positions, parameters_.least_new_area_m2, describe(*left_unseen_))};
}

}  // namespace nextview
