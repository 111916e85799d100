#include "planner/next_view.h"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <unordered_map>

#include "planner/prediction/orientations.h"
#include "sensor/random_stream.h"

namespace nextview {

namespace {

constexpr double kInfeasible = -std::numeric_limits<double>::infinity();

/// An infeasible vertex of the initial simplex is drawn again up to this many times. After the
/// first scan only a narrow cone of space is known, about a twentieth of all directions; a draw
/// costs little beside a prediction.
constexpr int kInitialDraws = 200;

/// Orientations nearer to each other than this are the same view.
constexpr double kSameDirection = 1e-9;  // of 1 - cos

struct BestView {
  std::size_t orientation = 0;
  Fitness fitness;
  bool any = false;
};

/// The fitness of positions, remembered by voxel.
class PositionFitness {
 public:
  PositionFitness(const VoxelMap& map, ViewPredictor& predictor, bool use_quality,
                  const SensorPose& present)
      : map_(map),
        predictor_(predictor),
        use_quality_(use_quality),
        present_(map.grid().voxel_of(present.position_m)),
        present_direction_(viewing_direction(present.pan_rad, present.tilt_rad)) {}

  /// Works out the fitness of positions, as far as it is not known, all together.
  void learn(
      std::span<const Eigen::Vector3d> positions_m,
      const std::function<void()>& meanwhile = [] {}) {
    unknown_.clear();
    for (const Eigen::Vector3d& position_m : positions_m) {
      const VoxelIndex voxel = map_.grid().voxel_of(position_m);
      if (known_.try_emplace(map_.slot(voxel)).second) unknown_.push_back(voxel);
    }
    const std::size_t views = predictor_.orientations().size();
    counts_.resize(unknown_.size() * views);
    predictor_.predict_all(map_, unknown_, counts_, meanwhile);
    for (std::size_t i = 0; i < unknown_.size(); ++i) {
      known_[map_.slot(unknown_[i])] =
          best_view(unknown_[i], std::span(counts_).subspan(i * views, views));
    }
  }

  /// At a position that has been learnt.
  const BestView& at(const Eigen::Vector3d& position_m) const {
    return known_.at(map_.slot(map_.grid().voxel_of(position_m)));
  }

 private:
  BestView best_view(const VoxelIndex& voxel, std::span<const ViewCounts> counts) const {
    BestView best;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (voxel == present_ && just_scanned(predictor_.orientations()[i])) continue;
      const Fitness candidate = fitness(counts[i], use_quality_);
      if (!best.any || candidate.value > best.fitness.value) best = {i, candidate, true};
    }
    return best;
  }

  // The same scan again would add nothing, whatever its fitness.
  bool just_scanned(const Orientation& orientation) const {
    return orientation.direction.dot(present_direction_) > 1.0 - kSameDirection;
  }

  const VoxelMap& map_;
  ViewPredictor& predictor_;
  bool use_quality_;
  VoxelIndex present_;
  Eigen::Vector3d present_direction_;
  std::vector<VoxelIndex> unknown_;  // and their counts, of one call
  std::vector<ViewCounts> counts_;
  std::unordered_map<std::size_t, BestView> known_;  // by slot
};

/// The present position, and three positions each along a random ray inside a random face (P21).
std::array<Eigen::Vector3d, 4> initial_vertices(const Eigen::Vector3d& present_m,
                                                const PlannerParameters& parameters,
                                                FeasibleSpace& space, RandomStream& random) {
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
      if (space.reachable(vertices[i])) break;
    }
  }
  return vertices;
}

/// Where the search has led, which has found a feasible position.
Decision decision_of(const SimplexResult& search, const PositionFitness& fitness_at,
                     const SensorPose& present, const std::vector<Orientation>& orientations) {
  Decision decision;
  const BestView& chosen = fitness_at.at(search.best.position);
  const Orientation& orientation = orientations[chosen.orientation];
  decision.pose = {search.best.position, orientation.pan_rad, orientation.tilt_rad};
  decision.waypoints_m = {present.position_m, search.best.position};
  decision.fitness = chosen.fitness;
  decision.iterations = search.iterations;
  decision.evaluations = static_cast<int>(search.tried.size());
  for (const SimplexTrial& trial : search.tried) {
    TriedPosition tried{trial.position, 0.0, 0.0, -1.0, trial.move};
    if (trial.value != kInfeasible) {
      const BestView& best = fitness_at.at(trial.position);
      tried.pan_rad = orientations[best.orientation].pan_rad;
      tried.tilt_rad = orientations[best.orientation].tilt_rad;
      tried.fitness = best.fitness.value;
    }
    decision.tried.push_back(tried);
  }
  return decision;
}

}  // namespace

void PlannerParameters::check() const {
  if (!(step_min_m > 0.0) || !std::isfinite(step_min_m)) {
    throw std::invalid_argument("step_min_m must be a positive length");
  }
  if (!(step_max_m >= step_min_m) || !std::isfinite(step_max_m)) {
    throw std::invalid_argument("step_max_m must be at least step_min_m");
  }
  if (!(fitness_tolerance >= 0.0) || !std::isfinite(fitness_tolerance)) {
    throw std::invalid_argument("fitness_tolerance must be 0 or more");
  }
  if (max_evaluations < 4) throw std::invalid_argument("max_evaluations must be at least 4");
  feasibility.check();
}

std::optional<Decision> decide_next_view(const VoxelMap& map, ViewPredictor& predictor,
                                         const PlannerParameters& parameters,
                                         const SensorPose& present, std::int64_t seed, int view,
                                         int attempt, std::span<const SensorPose> refused) {
  parameters.check();
  if (parameters.use_quality && !predictor.counts_quality()) {
    throw std::invalid_argument("the view predictor does not count quality, but use_quality is on");
  }
  FeasibleSpace space(map, parameters.feasibility, present.position_m, refused,
                      [&](const VoxelIndex& voxel) { return predictor.free_distance(voxel); });
  PositionFitness fitness_at(map, predictor, parameters.use_quality, present);
  const auto values = [&](std::span<const Eigen::Vector3d> positions_m) {
    std::vector<Eigen::Vector3d> reachable_m;
    std::vector<double> result(positions_m.size(), kInfeasible);
    for (std::size_t i = 0; i < positions_m.size(); ++i) {
      if (!space.reachable(positions_m[i])) continue;
      reachable_m.push_back(positions_m[i]);
      result[i] = 0.0;
    }
    fitness_at.learn(reachable_m);
    for (std::size_t i = 0; i < positions_m.size(); ++i) {
      if (result[i] == kInfeasible) continue;
      const BestView& best = fitness_at.at(positions_m[i]);
      result[i] = best.any ? best.fitness.value : kInfeasible;
    }
    return result;
  };

  RandomStream random(seed, view, attempt, RandomPurpose::InitialSimplex);
  std::array<Eigen::Vector3d, 4> vertices;
  fitness_at.learn({&present.position_m, 1}, [&] {
    vertices = initial_vertices(present.position_m, parameters, space, random);
  });
  const SimplexResult search = maximise_by_simplex(vertices, values, parameters.fitness_tolerance,
                                                   parameters.max_evaluations);
  if (search.best.value == kInfeasible) return std::nullopt;
  return decision_of(search, fitness_at, present, predictor.orientations());
}

}  // namespace nextview
