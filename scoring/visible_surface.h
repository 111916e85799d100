#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <stop_token>
#include <vector>

#include "scene/scene.h"
#include "scoring/reachable_positions.h"

namespace nextview {

/// The surface a run could see at best; what it did see is held against it.
struct VisibleSurface {
  std::vector<Eigen::Vector3f> points_m;  ///< samples that can be seen, world frame
  std::int64_t samples = 0;               ///< seen or not
  std::int64_t positions = 0;             ///< looked from

  /// In m^2, one side of every triangle.
  double area_m2() const { return static_cast<double>(points_m.size()) / kSamplesPerM2; }

  static constexpr double kSamplesPerM2 = 400.0;
};

/// Samples of the surface that can be seen in range from a position that can be reached from the
/// start: independent of anything scanned. What is left when stop is requested is incomplete and
/// to be thrown away.
VisibleSurface visible_surface(const Scene& scene, const Eigen::Vector3d& start_m,
                               const ReachParameters& reach, double range_max_m,
                               const std::stop_token& stop = {});

}  // namespace nextview
