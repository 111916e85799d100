#include "planner/face_refinement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <queue>

#include "sensor/elementary_functions.h"

namespace nextview {

namespace {

constexpr std::size_t kFaces = 20;
constexpr std::size_t kParts = 4;

/// By how much what is predicted changes from a face's centre to the centres in it, by the face's
/// level. Chosen over states of maps of random rooms, so that the best of 320 and of 1280
/// orientations is missed in less than one of twenty; docs/experiments.md says what they cost.
struct Slack {
  double share;   ///< of a_ov
  double factor;  ///< of a factor that asks for surfaces
};
constexpr std::array<Slack, 3> kSlacks = {{{0.5, 0.6}, {0.22, 0.3}, {0.15, 0.15}}};
/// a_op - a_us changes by so much more than a_ov.
constexpr double kDifferenceSlack = 1.5;

Slack slack_of(int subdivisions) {
  Slack slack = kSlacks[static_cast<std::size_t>(std::min(subdivisions, 2))];
  // What a view meets changes in proportion to how far it turns.
  for (int level = 2; level < subdivisions; ++level) {
    slack.share /= 2.0;
    slack.factor /= 2.0;
  }
  return slack;
}

// The largest f_area with shares that differ by no more than some.
double best_area_fitness(const Fitness& face, double slack) {
  constexpr double kBestShare = 0.4;  // f_area falls on both sides of it (P16)
  const double least = std::max(0.0, face.share_occupied - slack);
  const double most = std::min(1.0, face.share_occupied + slack);
  const double difference = std::max(
      0.0, std::abs(face.share_occlusion_plane - face.share_unseen) - kDifferenceSlack * slack);
  return area_fitness(std::clamp(kBestShare, least, most), difference, 0.0);
}

double product_of_factors(const Fitness& face, double slack, const FactorWeights& weights) {
  double product = 1.0;
  for (std::size_t i = 0; i < kFactors.size(); ++i) {
    const double more = kFactors[i].of_surfaces != nullptr ? slack : 0.0;
    product *= 1.0 + weights[i] * std::min(1.0, face.factors[i] + more);
  }
  return product;
}

struct HopefulFace {
  double hope;
  int level;
  std::size_t face;  // of its level
};

struct LessHopeful {
  bool operator()(const HopefulFace& a, const HopefulFace& b) const {
    if (a.hope != b.hope) return a.hope < b.hope;
    return a.level != b.level ? a.level > b.level : a.face > b.face;
  }
};

std::vector<std::size_t> numbers(std::size_t first, std::size_t count) {
  std::vector<std::size_t> result(count);
  std::iota(result.begin(), result.end(), first);
  return result;
}

}  // namespace

double hope_within(const Fitness& face, int subdivisions, const FactorWeights& weights) {
  const Slack slack = slack_of(subdivisions);
  const double area =
      area_fitness(face.share_occupied, face.share_occlusion_plane, face.share_unseen);
  const double factors = product_of_factors(face, 0.0, weights);
  const double by_shares = best_area_fitness(face, slack.share) * factors - face.value;
  const double by_factors = area * product_of_factors(face, slack.factor, weights) - face.value;
  return face.value + elementary::hypot(by_shares, by_factors);
}

FaceRefinement::FaceRefinement(int subdivisions) : subdivisions_(subdivisions) {
  for (int level = 0; level <= std::max(subdivisions, 0); ++level) {
    const std::vector<Orientation> of_level =
        icosahedron_orientations(subdivisions < 0 ? subdivisions : level);
    orientations_.insert(orientations_.end(), of_level.begin(), of_level.end());
  }
}

std::size_t FaceRefinement::first_of(int subdivisions) {
  std::size_t first = 0;
  std::size_t faces = kFaces;
  for (int level = 0; level < subdivisions; ++level, faces *= kParts) first += faces;
  return first;
}

BestView FaceRefinement::best_view(const Evaluate& evaluate, const MayBeChosen& may_be_chosen,
                                   const FactorWeights& weights) const {
  std::priority_queue<HopefulFace, std::vector<HopefulFace>, LessHopeful> hopeful;
  std::vector<Fitness> values;
  BestView best;
  const auto try_faces = [&](int level, std::size_t first, std::size_t count) {
    const std::vector<std::size_t> which = numbers(first_of(level) + first, count);
    values.assign(count, Fitness());
    evaluate(which, values);
    for (std::size_t i = 0; i < count; ++i) {
      if (level < subdivisions_) {
        hopeful.push({hope_within(values[i], level, weights), level, first + i});
        continue;
      }
      const bool better = !best.any || values[i].value > best.fitness.value ||
                          (values[i].value == best.fitness.value && which[i] < best.orientation);
      if (better && may_be_chosen(which[i])) best = {which[i], values[i], true};
    }
  };
  try_faces(0, 0, kFaces);
  while (!hopeful.empty()) {
    const HopefulFace face = hopeful.top();
    if (best.any && face.hope <= best.fitness.value) break;
    hopeful.pop();
    try_faces(face.level + 1, kParts * face.face, kParts);
  }
  return best;
}

}  // namespace nextview
