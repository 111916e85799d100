#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "planner/fitness.h"
#include "planner/prediction/orientations.h"

namespace nextview {

/// The best orientation at a position.
struct BestView {
  std::size_t orientation = 0;  ///< of the predictor's
  Fitness fitness;
  bool any = false;  ///< false: there is none to choose from
};

/// The most a face's fitness may be exceeded by what lies in it, on good grounds but not for
/// certain: from the face's centre to that of a part of it each of the shares a_ov, a_op - a_us and
/// each factor that asks for surfaces changes by no more than the slack of the face's level. The
/// shares may use up theirs, or the factors, or each a part:
///
///     hope = f + sqrt((f with the best shares - f)^2 + (f with the best factors - f)^2)
///
/// @param subdivisions of the face's level, at least 0
double hope_within(const Fitness& face, int subdivisions, const FactorWeights& weights);

/// Finds the best of the 20, 80, 320, ... orientations that are the centres of an icosahedron's
/// faces without trying them all (P20): best face first, a face is divided into its four parts as
/// long as there is hope that the best orientation lies in it.
///
///     try the 20 faces
///     while the most hopeful face has more hope than the best orientation so far is worth:
///       try its four parts; those of the last level are the orientations, others have hope again
///
/// Coarse faces are tried only to be led by; an orientation of the last level is the result. Where
/// nothing is hopeless all are tried, and the coarse faces, a third as many, for nothing.
class FaceRefinement {
 public:
  /// @param subdivisions of the last level: 0 to 6
  /// @throws std::invalid_argument for another number
  explicit FaceRefinement(int subdivisions);

  int subdivisions() const { return subdivisions_; }
  /// Of the faces of all levels, coarsest first, each level in the order of icosahedron_faces().
  const std::vector<Orientation>& orientations() const { return orientations_; }
  /// Of the last level, which are the last of orientations().
  std::span<const Orientation> finest() const {
    return std::span(orientations_).subspan(first_of(subdivisions_));
  }
  /// The place in orientations() of the first face of a level.
  static std::size_t first_of(int subdivisions);

  /// Fills in the fitness of some of orientations().
  using Evaluate = std::function<void(std::span<const std::size_t> which, std::span<Fitness>)>;
  /// Whether one of them may be the result.
  using MayBeChosen = std::function<bool(std::size_t orientation)>;

  /// The best orientation of the last level of those tried, ties to the lowest.
  /// @param weights what Evaluate goes by
  BestView best_view(const Evaluate& evaluate, const MayBeChosen& may_be_chosen,
                     const FactorWeights& weights) const;

 private:
  int subdivisions_;
  std::vector<Orientation> orientations_;
};

}  // namespace nextview
