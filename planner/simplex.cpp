#include "planner/simplex.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace nextview {

namespace {

constexpr double kInfeasible = -std::numeric_limits<double>::infinity();

class Simplex {
 public:
  Simplex(const ValuesOfPositions& values, SimplexResult& result)
      : values_(values), result_(result) {}

  /// Tries the first vertices, in their order.
  void try_first(std::span<const Eigen::Vector3d> positions) {
    const std::vector<double> values = values_(positions);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const SimplexMove move = i == 0 ? SimplexMove::FirstVertex : SimplexMove::InitialVertex;
      vertices_.push_back(note({positions[i], values.at(i), move}));
    }
  }

  /// Best first; of equal vertices the older one.
  void sort() {
    std::stable_sort(
        vertices_.begin(), vertices_.end(),
        [](const SimplexTrial& a, const SimplexTrial& b) { return a.value > b.value; });
  }

  const SimplexTrial& best() const { return vertices_.front(); }
  const SimplexTrial& second_worst() const { return vertices_[vertices_.size() - 2]; }
  const SimplexTrial& worst() const { return vertices_.back(); }

  bool flat(double tolerance) const {
    return best().value == kInfeasible || best().value - worst().value < tolerance;
  }

  /// One iteration: the vertices are sorted before it, and not after it.
  void climb() {
    Eigen::Vector3d face = Eigen::Vector3d::Zero();  // centre of the face opposite the worst
    for (const SimplexTrial& vertex : vertices_) face += vertex.position / 3.0;
    face -= worst().position / 3.0;
    const Eigen::Vector3d across = face - worst().position;

    const SimplexTrial reflected = try_at(face + across, SimplexMove::Reflection);
    if (reflected.value > best().value) {
      const SimplexTrial expanded = try_at(face + 2.0 * across, SimplexMove::Expansion);
      vertices_.back() = expanded.value > reflected.value ? expanded : reflected;
      return;
    }
    if (reflected.value > second_worst().value) {
      vertices_.back() = reflected;
      return;
    }
    if (reflected.value > worst().value) vertices_.back() = reflected;
    const SimplexTrial contracted =
        try_at(0.5 * (face + worst().position), SimplexMove::Contraction1D);
    if (contracted.value > worst().value) {
      vertices_.back() = contracted;
      return;
    }
    contract_towards_best();
  }

 private:
  SimplexTrial note(const SimplexTrial& trial) { return result_.tried.emplace_back(trial); }

  SimplexTrial try_at(const Eigen::Vector3d& position, SimplexMove move) {
    return note({position, values_({&position, 1}).at(0), move});
  }

  void contract_towards_best() {
    std::array<Eigen::Vector3d, 3> positions;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      positions[i] = 0.5 * (best().position + vertices_[i + 1].position);
    }
    const std::vector<double> values = values_(positions);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      vertices_[i + 1] = note({positions[i], values.at(i), SimplexMove::Contraction3D});
    }
  }

  const ValuesOfPositions& values_;
  SimplexResult& result_;
  std::vector<SimplexTrial> vertices_;
};

}  // namespace

SimplexResult maximise_by_simplex(const std::array<Eigen::Vector3d, 4>& vertices,
                                  const ValuesOfPositions& values, double tolerance,
                                  int max_evaluations) {
  if (max_evaluations < 4) throw std::invalid_argument("a simplex needs at least 4 evaluations");
  if (!(tolerance >= 0.0)) throw std::invalid_argument("a simplex's tolerance must be 0 or more");
  SimplexResult result;
  Simplex simplex(values, result);
  simplex.try_first(vertices);
  simplex.sort();
  while (!simplex.flat(tolerance) &&
         result.tried.size() < static_cast<std::size_t>(max_evaluations)) {
    simplex.climb();
    simplex.sort();
    ++result.iterations;
  }
  result.best = simplex.best();
  return result;
}

}  // namespace nextview
