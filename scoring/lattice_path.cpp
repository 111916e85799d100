#include "scoring/lattice_path.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <stdexcept>
#include <utility>

namespace nextview {
namespace {

std::uint64_t key_of(const Eigen::Vector3i& node) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    key = key << 21 | static_cast<std::uint64_t>(node[axis] + (1 << 20));
  }
  return key;
}

}  // namespace

LatticePaths::LatticePaths(const std::vector<Eigen::Vector3d>& positions_m, double spacing_m)
    : spacing_m_(spacing_m) {
  if (positions_m.empty()) throw std::invalid_argument("lattice paths: no positions");
  for (const Eigen::Vector3d& position : positions_m) {
    const Eigen::Vector3i node = (position.array() / spacing_m).round().cast<int>();
    number_of_.emplace(key_of(node), static_cast<std::uint32_t>(nodes_.size()));
    nodes_.push_back(node);
  }
}

std::uint32_t LatticePaths::nearest(const Eigen::Vector3d& position_m) const {
  const Eigen::Vector3i node = (position_m.array() / spacing_m_).round().cast<int>();
  const auto found = number_of_.find(key_of(node));
  if (found != number_of_.end()) return found->second;
  const auto distance = [&](const Eigen::Vector3i& other) {
    return (spacing_m_ * other.cast<double>() - position_m).squaredNorm();
  };
  return static_cast<std::uint32_t>(
      std::min_element(nodes_.begin(), nodes_.end(),
                       [&](const auto& a, const auto& b) { return distance(a) < distance(b); }) -
      nodes_.begin());
}

double LatticePaths::length_m(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) const {
  const std::uint32_t first = nearest(from_m);
  const std::uint32_t last = nearest(to_m);
  const auto at_m = [&](std::uint32_t node) -> Eigen::Vector3d {
    return spacing_m_ * nodes_[node].cast<double>();
  };
  // A*: by the length so far and what is left at least.
  std::vector<double> length_m(nodes_.size(), std::numeric_limits<double>::infinity());
  std::priority_queue<std::pair<double, std::uint32_t>,
                      std::vector<std::pair<double, std::uint32_t>>, std::greater<>>
      queue;
  length_m[first] = (at_m(first) - from_m).norm();
  queue.emplace(length_m[first] + (at_m(last) - at_m(first)).norm(), first);
  while (!queue.empty()) {
    const auto [expected_m, node] = queue.top();
    queue.pop();
    if (node == last) return length_m[last] + (to_m - at_m(last)).norm();
    if (expected_m > length_m[node] + (at_m(last) - at_m(node)).norm() + 1e-9) continue;
    for (int i = 0; i < 27; ++i) {
      const Eigen::Vector3i step(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      const auto found = number_of_.find(key_of(nodes_[node] + step));
      if (found == number_of_.end()) continue;
      const double longer_m = length_m[node] + spacing_m_ * step.cast<double>().norm();
      if (longer_m >= length_m[found->second]) continue;
      length_m[found->second] = longer_m;
      queue.emplace(longer_m + (at_m(last) - at_m(found->second)).norm(), found->second);
    }
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace nextview
