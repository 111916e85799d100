#include "scoring/reachable_positions.h"

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <unordered_set>

namespace nextview {
namespace {

/// A grid index as one number: 21 bits an axis, far more than any box at this spacing holds.
std::uint64_t key_of(const Eigen::Vector3i& cell) {
  constexpr int kOffset = 1 << 20;
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    key = key << 21 | static_cast<std::uint64_t>(cell[axis] + kOffset);
  }
  return key;
}

bool inside(const Eigen::Vector3d& point, const ReachParameters& parameters) {
  return (point.array() >= parameters.box_min_m.array()).all() &&
         (point.array() <= parameters.box_max_m.array()).all();
}

}  // namespace

std::vector<Eigen::Vector3d> reachable_positions(const Scene& scene, const Eigen::Vector3d& start_m,
                                                 const ReachParameters& parameters) {
  if (!(parameters.spacing_m > 0.0) || !std::isfinite(parameters.spacing_m) ||
      !std::isfinite(parameters.clearance_m) || !start_m.allFinite() ||
      !parameters.box_min_m.allFinite() || !parameters.box_max_m.allFinite()) {
    throw std::invalid_argument(
        "reachable positions: spacing, clearance, start and box "
        "must be finite, the spacing positive");
  }
  std::vector<Eigen::Vector3d> positions = {start_m};
  std::vector<Eigen::Vector3i> cells = {Eigen::Vector3i::Zero()};
  std::unordered_set<std::uint64_t> reached = {key_of(cells[0])};
  // Breadth first; the two vectors grow behind the one being looked at.
  for (std::size_t at = 0; at < positions.size(); ++at) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const int step : {-1, 1}) {
        Eigen::Vector3i cell = cells[at];
        cell[axis] += step;
        if (reached.contains(key_of(cell))) continue;
        const Eigen::Vector3d position = start_m + parameters.spacing_m * cell.cast<double>();
        if (!inside(position, parameters)) continue;
        const Eigen::Vector3d from = positions[at];
        if (scene.clearance_m(from, position, parameters.clearance_m) < parameters.clearance_m) {
          continue;
        }
        reached.insert(key_of(cell));
        cells.push_back(cell);
        positions.push_back(position);
      }
    }
  }
  return positions;
}

}  // namespace nextview
