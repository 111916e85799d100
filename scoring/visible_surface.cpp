#include "scoring/visible_surface.h"

#include <algorithm>
#include <atomic>
#include <thread>

#include "scoring/position_tree.h"
#include "scoring/surface_samples.h"

namespace nextview {
namespace {

/// Tells of each point whether it can be seen from the tree's positions, on all cores. The threads
/// are started by the one that calls and so, on Linux, have its priority.
std::vector<std::uint8_t> seen_points(const PositionTree& tree,
                                      const std::vector<Eigen::Vector3f>& points_m,
                                      const std::stop_token& stop) {
  constexpr std::size_t kPointsAtATime = 1024;  // neighbours, who can learn from each other
  std::vector<std::uint8_t> seen(points_m.size(), 0);
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    PositionTree own_tree = tree;
    for (;;) {
      const std::size_t first = next.fetch_add(kPointsAtATime);
      const std::size_t last = std::min(first + kPointsAtATime, points_m.size());
      for (std::size_t i = first; i < last; ++i) {
        if (stop.stop_requested()) return;
        seen[i] = own_tree.sees(points_m[i].cast<double>()) ? 1 : 0;
      }
      if (last == points_m.size()) return;
    }
  };
  std::vector<std::jthread> others(std::max(1U, std::thread::hardware_concurrency()) - 1);
  for (std::jthread& other : others) other = std::jthread(work);
  work();
  for (std::jthread& other : others) other.join();
  return seen;
}

}  // namespace

VisibleSurface visible_surface(const Scene& scene, const Eigen::Vector3d& start_m,
                               const ReachParameters& reach, double range_max_m,
                               const std::stop_token& stop) {
  std::vector<Eigen::Vector3d> positions = reachable_positions(scene, start_m, reach);
  const std::vector<Eigen::Vector3f> samples =
      sample_surface(scene.mesh(), VisibleSurface::kSamplesPerM2);
  VisibleSurface surface;
  surface.samples = static_cast<std::int64_t>(samples.size());
  surface.positions = static_cast<std::int64_t>(positions.size());
  const TriangleNeighbours neighbours(scene.mesh());
  const PositionTree tree(scene, neighbours, std::move(positions), range_max_m);
  const std::vector<std::uint8_t> seen = seen_points(tree, samples, stop);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (seen[i] != 0) surface.points_m.push_back(samples[i]);
  }
  return surface;
}

}  // namespace nextview
