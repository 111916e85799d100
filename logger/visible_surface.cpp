#include "logger/visible_surface.h"

#include "logger/position_tree.h"
#include "logger/surface_samples.h"

namespace nextview {

VisibleSurface visible_surface(const Scene& scene, const Eigen::Vector3d& start_m,
                               const ReachParameters& reach, double range_max_m,
                               const std::stop_token& stop) {
  std::vector<Eigen::Vector3d> positions = reachable_positions(scene, start_m, reach);
  const std::vector<Eigen::Vector3f> samples =
      sample_surface(scene.mesh(), VisibleSurface::kSamplesPerM2);
  VisibleSurface surface;
  surface.samples = static_cast<std::int64_t>(samples.size());
  surface.positions = static_cast<std::int64_t>(positions.size());
  PositionTree tree(scene, std::move(positions), range_max_m);
  for (const Eigen::Vector3f& point_m : samples) {
    if (stop.stop_requested()) break;
    if (tree.sees(point_m.cast<double>())) surface.points_m.push_back(point_m);
  }
  return surface;
}

}  // namespace nextview
