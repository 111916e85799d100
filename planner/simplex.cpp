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
  Simplex(const std::function<double(const Eigen::Vector3d&)>& value, SimplexResult& result)
      : value_(value), result_(result) {}

  SimplexTrial try_at(const Eigen::Vector3d& position, SimplexMove move) {
    result_.tried.push_back({position, value_(position), move});
    return result_.tried.back();
  }

  void add(const SimplexTrial& vertex) { vertices_.push_back(vertex); }

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
    for (std::size_t i = 1; i < vertices_.size(); ++i) {
      vertices_[i] =
          try_at(0.5 * (best().position + vertices_[i].position), SimplexMove::Contraction3D);
    }
  }

 private:
  const std::function<double(const Eigen::Vector3d&)>& value_;
  SimplexResult& result_;
  std::vector<SimplexTrial> vertices_;
};

}  // namespace

SimplexResult maximise_by_simplex(const std::array<Eigen::Vector3d, 4>& vertices,
                                  const std::function<double(const Eigen::Vector3d&)>& value,
                                  double tolerance, int max_evaluations) {
  if (max_evaluations < 4) throw std::invalid_argument("a simplex needs at least 4 evaluations");
  if (!(tolerance >= 0.0)) throw std::invalid_argument("a simplex's tolerance must be 0 or more");
  SimplexResult result;
  Simplex simplex(value, result);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const SimplexMove move = i == 0 ? SimplexMove::FirstVertex : SimplexMove::InitialVertex;
    simplex.add(simplex.try_at(vertices[i], move));
  }
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
