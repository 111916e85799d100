#include "planner/travel.h"

#include <algorithm>

namespace nextview {

Travel travel_along(std::span<const Eigen::Vector3d> waypoints_m) {
  Travel travel;
  Eigen::Vector3d heading = Eigen::Vector3d::Zero();  // of the last piece that has a length
  for (std::size_t i = 1; i < waypoints_m.size(); ++i) {
    const Eigen::Vector3d piece_m = waypoints_m[i] - waypoints_m[i - 1];
    const double length_m = piece_m.norm();
    travel.length_m += length_m;
    if (length_m == 0.0) continue;
    const Eigen::Vector3d next = piece_m / length_m;
    if (!heading.isZero(0.0)) travel.turning += std::max(0.0, 1.0 - heading.dot(next));
    heading = next;
  }
  return travel;
}

}  // namespace nextview
