#include "planner/paper_strategy.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "lcmtypes/parameter_bounds.h"
#include "planner/prediction/fast_view_predictor.h"
#include "planner/prediction/orientations.h"
#include "planner/prediction/panorama_view_predictor.h"
#include "planner/strategy_inputs.h"
#include "planner/view_evaluator.h"
#include "sensor/random_stream.h"

namespace nextview {

namespace {

constexpr double kInfeasible = -std::numeric_limits<double>::infinity();

/// An infeasible vertex of the initial simplex is drawn again up to this many times. After the
/// first scan only a narrow cone of space is known, about a twentieth of all directions; a draw
/// costs little beside a prediction.
constexpr int kInitialDraws = 200;

/// Where the simplex may try positions.
class FeasiblePositions {
 public:
  FeasiblePositions(const Situation& situation, ShortestPaths& paths,
                    const FeasibilityParameters& parameters)
      : situation_(situation), paths_(paths), parameters_(parameters) {}

  bool reachable(const Eigen::Vector3d& position_m) {
    if (!parameters_.within_limits(position_m) || !paths_.may_be_at(position_m)) return false;
    const VoxelGrid& grid = situation_.space.map().grid();
    const VoxelIndex voxel = grid.voxel_of(position_m);
    for (const SensorPose& refused : situation_.refused) {
      if (grid.voxel_of(refused.position_m) == voxel) return false;
    }
    // Most positions are straight ahead, and a search for all paths costs more than a prediction.
    if (paths_.leads_straight_to(position_m)) return true;
    paths_.find_as_far_as(voxel);
    return paths_.length_m(voxel) != ShortestPaths::kUnreachable;
  }

 private:
  const Situation& situation_;
  ShortestPaths& paths_;
  const FeasibilityParameters& parameters_;
};

/// The present position, and three positions each along a random ray inside a random face (P21).
std::array<Eigen::Vector3d, 4> initial_vertices(const Eigen::Vector3d& present_m,
                                                const PlannerParameters& parameters,
                                                FeasiblePositions& feasible, RandomStream& random) {
  const std::vector<SphereTriangle> faces = icosahedron_faces();
  std::array<Eigen::Vector3d, 4> vertices;
  vertices[0] = present_m;
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    for (int draw = 0; draw < kInitialDraws; ++draw) {
      const SphereTriangle& face = faces[random.below(static_cast<std::uint32_t>(faces.size()))];
      const Eigen::Vector3d direction = random_direction_in(face, random);
      const double distance_m = parameters.step_min_m +
                                random.uniform() * (parameters.step_max_m - parameters.step_min_m);
      vertices[i] = present_m + distance_m * direction;
      if (feasible.reachable(vertices[i])) break;
    }
  }
  return vertices;
}

std::string reason_of(const Decision& decision) {
  const auto percent = [](double share) { return fmt::format("{}", std::lround(100.0 * share)); };
  const Fitness& fitness = decision.fitness;
  return "the best of " + std::to_string(decision.evaluations) +
         " positions tried: of what its rays meet " + percent(fitness.share_occupied) +
         " % is Occupied, " + percent(fitness.share_occlusion_plane) +
         " % an occlusion plane and " + percent(fitness.share_unseen) + " % unseen";
}

/// Where the search has led, which has found a feasible position.
Decision decision_of(const SimplexResult& search, const ViewEvaluator& evaluator,
                     const ShortestPaths& paths) {
  const std::vector<Orientation>& orientations = evaluator.orientations();
  Decision decision;
  const BestView& chosen = evaluator.at(search.best.position);
  const Orientation& orientation = orientations[chosen.orientation];
  decision.pose = {search.best.position, orientation.pan_rad, orientation.tilt_rad};
  decision.waypoints_m = paths.waypoints_to_m(search.best.position);
  decision.fitness = chosen.fitness;
  decision.iterations = search.iterations;
  decision.evaluations = static_cast<int>(search.tried.size());
  for (const SimplexTrial& trial : search.tried) {
    TriedPosition tried{trial.position, 0.0, 0.0, -1.0, trial.move};
    if (trial.value != kInfeasible) {
      const BestView& best = evaluator.at(trial.position);
      tried.pan_rad = orientations[best.orientation].pan_rad;
      tried.tilt_rad = orientations[best.orientation].tilt_rad;
      tried.fitness = best.fitness.value;
    }
    decision.tried.push_back(tried);
  }
  decision.strategy = PaperStrategy::kFacts.name;
  decision.reason = reason_of(decision);
  return decision;
}

/// Every ray of every orientation, or with more than 20 orientations one panorama that answers them
/// all.
std::unique_ptr<ViewPredictor> predictor_for(const StrategyInputs& inputs) {
  const bool counts_surfaces = ask_for_surfaces(inputs.search.weights);
  if (inputs.orientations.size() > 20) {
    return std::make_unique<PanoramaViewPredictor>(
        inputs.raster, inputs.voxel_size_m, inputs.orientations, counts_surfaces, inputs.threads);
  }
  return std::make_unique<FastViewPredictor>(inputs.raster, inputs.voxel_size_m,
                                             inputs.orientations, counts_surfaces, inputs.threads);
}

}  // namespace

void PlannerParameters::check() const {
  for (const double weight : weights) bounds::kFactorWeight.require(weight);
  bounds::kStep.require(step_min_m);
  bounds::kStep.require(step_max_m);
  if (step_min_m > step_max_m) {
    throw std::invalid_argument("step_max_m must be at least step_min_m");
  }
  bounds::kFitnessTolerance.require(fitness_tolerance);
  bounds::kMaxEvaluations.require(max_evaluations);
  bounds::kDeparture.as("later_departure_m").require(later_departure_m);
  feasibility.check();
}

std::optional<Decision> decide_by_simplex(const Situation& situation, ShortestPaths& paths,
                                          ViewPredictor& predictor,
                                          const PlannerParameters& parameters) {
  parameters.check();
  if (ask_for_surfaces(parameters.weights) && !predictor.counts_surfaces()) {
    throw std::invalid_argument(
        "a factor asks for the surfaces, which the view predictor does not count");
  }
  const SensorPose& present = situation.present;
  FeasiblePositions feasible(situation, paths, parameters.feasibility);
  ViewEvaluator evaluator(situation.space, predictor, parameters.weights, present, paths,
                          parameters.refined_by());
  const auto values = [&](std::span<const Eigen::Vector3d> positions_m) {
    std::vector<Eigen::Vector3d> reachable_m;
    std::vector<double> result(positions_m.size(), kInfeasible);
    for (std::size_t i = 0; i < positions_m.size(); ++i) {
      if (!feasible.reachable(positions_m[i])) continue;
      reachable_m.push_back(positions_m[i]);
      result[i] = 0.0;
    }
    evaluator.evaluate(reachable_m);
    for (std::size_t i = 0; i < positions_m.size(); ++i) {
      if (result[i] == kInfeasible) continue;
      const BestView& best = evaluator.at(positions_m[i]);
      result[i] = best.any ? best.fitness.value : kInfeasible;
    }
    return result;
  };

  RandomStream random(situation.seed, situation.view, situation.attempt,
                      RandomPurpose::InitialSimplex);
  const SimplexResult search =
      maximise_by_simplex(initial_vertices(present.position_m, parameters, feasible, random),
                          values, parameters.fitness_tolerance, parameters.max_evaluations);
  if (search.best.value == kInfeasible) return std::nullopt;
  return decision_of(search, evaluator, paths);
}

std::unique_ptr<Strategy> PaperStrategy::make(const StrategyInputs& inputs) {
  return std::make_unique<PaperStrategy>(
      inputs.search, inputs.stop, inputs.voxel_size_m, predictor_for(inputs),
      std::make_unique<FastViewPredictor>(inputs.coarse_raster, inputs.voxel_size_m,
                                          inputs.orientations, false, inputs.threads));
}

PaperStrategy::PaperStrategy(const PlannerParameters& search, const StopParameters& stop,
                             double voxel_size_m, std::unique_ptr<ViewPredictor> predictor,
                             std::unique_ptr<ViewPredictor> coarse_predictor)
    : search_(search),
      stop_(stop),
      voxel_size_m_(voxel_size_m),
      predictor_(std::move(predictor)),
      coarse_predictor_(std::move(coarse_predictor)) {
  search_.check();
  stop_.check();
}

KnownSpace::Surfaces PaperStrategy::surfaces() const {
  return predictor_->counts_surfaces() ? KnownSpace::Surfaces::Keep : KnownSpace::Surfaces::Leave;
}

void PaperStrategy::view_folded(const FoldedView& folded) {
  const std::vector<std::uint32_t>& changed = folded.report.changed_slots;
  changed_slots_.insert(changed_slots_.end(), changed.begin(), changed.end());
  views_.push_back(view_facts(folded.report, folded.statistics, voxel_size_m_));
}

std::optional<Ending> PaperStrategy::ending() const {
  const std::optional<StopReason> reason = should_stop(views_, stop_);
  if (reason != StopReason::QualityReached) return std::nullopt;
  return Ending{*reason, std::string(describe(*reason))};
}

void PaperStrategy::follow_map(const VoxelMap& map) {
  if (!clear_ || clear_->window() != map.window()) {
    clear_.emplace(map, search_.feasibility);
    refused_.clear();
  } else {
    refused_.forget_near(*clear_, map, clear_->update(map, changed_slots_));
  }
  changed_slots_.clear();
}

NextView PaperStrategy::next_view(const Situation& situation) {
  const VoxelMap& map = situation.space.map();
  follow_map(map);
  if (!situation.refused.empty()) refused_.add(*clear_, way_m_, situation.refused.size());
  const bool first_move = situation.view == 2;
  paths_.stand_at(*clear_, map, situation.present.position_m,
                  first_move ? search_.feasibility.departure_m : search_.later_departure_m);
  NextView next = decided(situation);
  if (const Decision* decision = std::get_if<Decision>(&next)) way_m_ = decision->waypoints_m;
  return next;
}

NextView PaperStrategy::last_look(const Situation& situation, StopReason otherwise) {
  paths_.find_all();
  const FaceRefinement* refinement = search_.refined_by();
  ViewEvaluator evaluator(situation.space, *predictor_, {}, situation.present, paths_, refinement);
  ViewEvaluator coarse(situation.space, *coarse_predictor_, {}, situation.present, paths_,
                       refinement);
  const std::optional<LastLook::View> found =
      last_look_.best_view(situation, paths_, coarse, evaluator);
  if (!found) {
    return Ending{otherwise, std::string(describe(otherwise)) + " From none of " +
                                 std::to_string(last_look_.voxels_asked()) +
                                 " positions that can be reached a view has a fitness above 0.6."};
  }
  const VoxelGrid& grid = situation.space.map().grid();
  const auto position_m = [&](const VoxelIndex& voxel) {
    const Eigen::Vector3d& present_m = situation.present.position_m;
    return voxel == grid.voxel_of(present_m) ? present_m : grid.center_m(voxel);
  };
  Decision decision;
  for (const LastLook::View& view : last_look_.good()) {
    if (decision.tried.size() == Decision::kMostTried) break;
    const Orientation& orientation = evaluator.orientations()[view.best.orientation];
    decision.tried.push_back({position_m(view.voxel), orientation.pan_rad, orientation.tilt_rad,
                              view.best.fitness.value});
  }
  const Orientation& orientation = evaluator.orientations()[found->best.orientation];
  decision.pose = {position_m(found->voxel), orientation.pan_rad, orientation.tilt_rad};
  decision.waypoints_m = paths_.waypoints_to_m(decision.pose.position_m);
  decision.fitness =
      ViewEvaluator(situation.space, *predictor_, search_.weights, situation.present, paths_)
          .of_view(decision.pose.position_m, found->best.orientation);
  decision.evaluations = static_cast<int>(last_look_.voxels_asked());
  decision.strategy = kFacts.name;
  decision.reason = "the last views have shown nothing new; " + reason_of(decision);
  return decision;
}

NextView PaperStrategy::decided(const Situation& situation) {
  // A good view anywhere says that more unseen area is to be covered, which no rule knows.
  if (const auto reason = should_stop(views_, stop_)) return last_look(situation, *reason);
  std::optional<Decision> decision = decide_by_simplex(situation, paths_, *predictor_, search_);
  if (decision) return *std::move(decision);
  return Ending{StopReason::NoFeasibleGoal, "view " + std::to_string(situation.view) +
                                                ": no position is feasible from the last one"};
}

}  // namespace nextview
