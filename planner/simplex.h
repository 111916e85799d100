#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace nextview {

/// How the simplex came to try a position (P21). The numbers travel on the bus: never renumber.
enum class SimplexMove : std::int8_t {
  FirstVertex = 0,
  InitialVertex = 1,
  Reflection = 2,
  Expansion = 3,
  Contraction1D = 4,  ///< of the worst vertex towards the others
  Contraction3D = 5,  ///< of all vertices towards the best
};

/// A position the simplex asked the value of.
struct SimplexTrial {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double value = 0.0;  ///< -infinity: infeasible
  SimplexMove move = SimplexMove::FirstVertex;
};

struct SimplexResult {
  SimplexTrial best;                ///< best.value is -infinity when no trial was feasible
  int iterations = 0;               ///< reflections, each with what followed from it
  std::vector<SimplexTrial> tried;  ///< every evaluation, in order; the four vertices first
};

/// The values of positions, in their order. The simplex needs them all before it goes on, so they
/// can be worked out together.
using ValuesOfPositions = std::function<std::vector<double>(std::span<const Eigen::Vector3d>)>;

/// Hill climbing with a simplex of four vertices in three dimensions, after Nelder and Mead (P21):
/// the worst vertex is reflected in the face of the others; a new best is expanded to twice the
/// distance; a vertex that would still be the worst is contracted half way to the face (1-D), and
/// when that does not help all vertices are contracted half way to the best (3-D).
///
/// Maximises. -infinity marks an infeasible position: any vertex may be infeasible, and with
/// infeasible vertices the simplex reflects and contracts until it has left them. Of equal vertices
/// the one that came first counts as the better, so the same function gives the same search.
///
/// Stops when the values of the vertices differ by less than the tolerance (P22), when none is
/// feasible, or before an iteration when max_evaluations are used up (an iteration may overrun it
/// by no more than its own 5 evaluations). A tolerance of 0 stops only by the budget.
/// @throws std::invalid_argument when max_evaluations < 4 or the tolerance is negative or NaN
SimplexResult maximise_by_simplex(const std::array<Eigen::Vector3d, 4>& vertices,
                                  const ValuesOfPositions& values, double tolerance,
                                  int max_evaluations);

}  // namespace nextview
