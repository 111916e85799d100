#include "planner/paper_tidy_up_strategy.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "planner/paper_strategy.h"
#include "planner/strategy_inputs.h"
#include "planner/unseen_boundary.h"
#include "planner/view_candidates.h"

namespace nextview {

namespace {

constexpr double kCoarsest_m = 0.4;  // spacing of positions

double new_area_m2(std::span<const ViewFacts> views) {
  double area_m2 = 0.0;
  for (const ViewFacts& view : views) area_m2 += view.newly_occupied_area_m2;
  return area_m2;
}

// What the sensor's rays would meet from a pose.
Fitness fitness_of(const KnownSpace& space, const PredictionRaster& raster, const HoleView& view) {
  const Orientation orientation{view.pan_rad, view.tilt_rad,
                                viewing_direction(view.pan_rad, view.tilt_rad)};
  PlainViewPredictor predictor(raster, space.map().grid().voxel_size_m, {orientation}, false);
  ViewCounts counts;
  predictor.predict(space, view.voxel, {&counts, 1});
  return fitness(counts);
}

}  // namespace

void TidyUpParameters::check() const {
  if (!(fallen_yield >= 0.0 && fallen_yield <= 1.0)) {
    throw std::invalid_argument("fallen_yield must be in [0, 1]");
  }
  if (yield_views < 1) throw std::invalid_argument("yield_views must be at least 1");
  if (!(largest_hole_m > 0.0 && std::isfinite(largest_hole_m))) {
    throw std::invalid_argument("largest_hole_m must be a positive length");
  }
  view.check();
  feasibility.check();
}

bool yield_has_fallen(std::span<const ViewFacts> views, const TidyUpParameters& parameters) {
  const auto last = static_cast<std::size_t>(parameters.yield_views);
  if (views.size() <= 2 * last) return false;
  const std::span<const ViewFacts> chosen = views.subspan(1);
  const double mean_m2 = new_area_m2(chosen) / static_cast<double>(chosen.size());
  const double now_m2 = new_area_m2(chosen.last(last)) / static_cast<double>(last);
  return now_m2 < parameters.fallen_yield * mean_m2;
}

std::unique_ptr<Strategy> PaperTidyUpStrategy::make(const StrategyInputs& inputs) {
  return std::make_unique<PaperTidyUpStrategy>(PaperStrategy::make(inputs), inputs.stop,
                                               inputs.tidy_up, inputs.raster, inputs.voxel_size_m);
}

PaperTidyUpStrategy::PaperTidyUpStrategy(std::unique_ptr<Strategy> simplex,
                                         const StopParameters& stop,
                                         const TidyUpParameters& tidy_up,
                                         const PredictionRaster& raster, double voxel_size_m)
    : simplex_(std::move(simplex)),
      stop_(stop),
      parameters_(tidy_up),
      raster_(raster),
      voxel_size_m_(voxel_size_m) {
  stop_.check();
  parameters_.check();
}

void PaperTidyUpStrategy::view_folded(const FoldedView& folded) {
  simplex_->view_folded(folded);
  views_.push_back(view_facts(folded.report, folded.statistics, voxel_size_m_));
  if (phase_ != Phase::TidyingUp) return;
  const std::vector<std::uint32_t>& changed = folded.report.changed_slots;
  changed_slots_.insert(changed_slots_.end(), changed.begin(), changed.end());
}

NextView PaperTidyUpStrategy::next_view(const Situation& situation) {
  if (phase_ == Phase::Simplex) {
    StopParameters rule_1 = stop_;
    rule_1.rule = StopRule::NothingNew;
    if (yield_has_fallen(views_, parameters_) || should_stop(views_, rule_1)) {
      phase_ = Phase::TidyingUp;
    }
  }
  if (phase_ != Phase::TidyingUp) return by_simplex(situation);
  if (auto decision = tidy_up(situation)) return *std::move(decision);
  if (stop_.rule == StopRule::NothingNew) return nothing_left(situation);
  phase_ = Phase::TidiedUp;
  Situation unrefused = situation;  // what was refused were no goals of the simplex
  unrefused.refused = {};
  return by_simplex(unrefused);
}

NextView PaperTidyUpStrategy::by_simplex(const Situation& situation) {
  NextView next = simplex_->next_view(situation);
  if (Decision* decision = std::get_if<Decision>(&next)) decision->strategy = kFacts.name;
  return next;
}

void PaperTidyUpStrategy::follow_map(const Situation& situation) {
  const VoxelMap& map = situation.space.map();
  if (followed_view_ == situation.view) return;
  followed_view_ = situation.view;
  if (!clear_ || clear_->window() != map.window()) {
    clear_.emplace(map, parameters_.feasibility);
    refused_.clear();
    in_vain_.clear();
    aimed_at_.clear();
  } else {
    refused_.forget_near(*clear_, map, clear_->update(map, changed_slots_));
  }
  changed_slots_.clear();
  doubt_what_was_not_seen(map);
}

void PaperTidyUpStrategy::doubt_what_was_not_seen(const VoxelMap& map) {
  for (const std::uint32_t slot : aimed_at_) {
    const Label label = map.labels()[slot];
    if (label != Label::Empty && label != Label::Occupied) ++in_vain_[slot];
  }
  aimed_at_.clear();
}

std::vector<SurfaceHole> PaperTidyUpStrategy::trusted_holes(const VoxelMap& map) const {
  const int largest_voxels =
      std::max(1, static_cast<int>(parameters_.largest_hole_m / voxel_size_m_));
  std::vector<SurfaceHole> holes = surface_holes(map, largest_voxels);
  for (SurfaceHole& hole : holes) {
    for (HoleVoxel& voxel : hole.voxels) {
      const auto found = in_vain_.find(map.slot(voxel.voxel));
      if (found == in_vain_.end()) continue;
      voxel.trust = found->second < kMostInVain ? std::ldexp(1.0, -found->second) : 0.0;
    }
    std::erase_if(hole.voxels, [](const HoleVoxel& voxel) { return voxel.trust == 0.0; });
  }
  std::erase_if(holes, [](const SurfaceHole& hole) { return hole.voxels.empty(); });
  return holes;
}

std::optional<Decision> PaperTidyUpStrategy::tidy_up(const Situation& situation) {
  const VoxelMap& map = situation.space.map();
  follow_map(situation);
  if (!situation.refused.empty()) {
    aimed_at_.clear();  // nobody went there
    refused_.add(*clear_, way_m_, situation.refused.size());
  }
  paths_.find(*clear_, map, situation.present.position_m, parameters_.feasibility.departure_m);
  const std::vector<SurfaceHole> holes = trusted_holes(map);
  const VoxelIndex present = map.grid().voxel_of(situation.present.position_m);
  const auto coarsest = static_cast<unsigned>(std::lround(kCoarsest_m / voxel_size_m_));
  for (int spacing = static_cast<int>(std::bit_floor(std::max(coarsest, 1U))); spacing >= 1;
       spacing /= 2) {
    const PositionLattice positions(paths_, present, VoxelIndex::Zero(), spacing);
    const std::vector<HoleView> views = hole_views(situation.space.field(), voxel_size_m_, holes,
                                                   paths_, positions.voxels, parameters_.view);
    if (!views.empty()) return decision(situation, views);
  }
  return std::nullopt;
}

Decision PaperTidyUpStrategy::decision(const Situation& situation,
                                       const std::vector<HoleView>& views) {
  const VoxelMap& map = situation.space.map();
  const HoleView& chosen = views.front();
  for (const HoleVoxel* voxel : chosen.in_sight) {
    aimed_at_.push_back(static_cast<std::uint32_t>(map.slot(voxel->voxel)));
  }
  way_m_ = paths_.waypoints_to_m(chosen.voxel == map.grid().voxel_of(situation.present.position_m)
                                     ? situation.present.position_m
                                     : map.grid().center_m(chosen.voxel));
  Decision decision;
  decision.waypoints_m = way_m_;
  decision.pose = {way_m_.back(), chosen.pan_rad, chosen.tilt_rad};
  decision.fitness = fitness_of(situation.space, raster_, chosen);
  decision.strategy = kFacts.name;
  decision.expected_gain_m2 = chosen.gain_voxels * voxel_size_m_ * voxel_size_m_;
  decision.reason = fmt::format(
      "looks into the best of {} holes of the surface that can be looked into: {} of their voxels "
      "are in sight from there, {:.1f} m away",
      views.size(), chosen.in_sight.size(), chosen.path_m);
  decision.evaluations = static_cast<int>(views.size());
  for (const HoleView& view : views) {
    if (decision.tried.size() == Decision::kMostTried) break;
    decision.tried.push_back(
        {map.grid().center_m(view.voxel), view.pan_rad, view.tilt_rad, view.score / chosen.score});
  }
  return decision;
}

NextView PaperTidyUpStrategy::nothing_left(const Situation& situation) {
  const VoxelMap& map = situation.space.map();
  return Ending{StopReason::NothingLeft,
                fmt::format("Into no hole of the surface a view can be computed from any of {} "
                            "positions; {}",
                            paths_.reached().size(),
                            describe(unseen_boundary(map, *clear_, paths_, raster_.range_max_m)))};
}

}  // namespace nextview
