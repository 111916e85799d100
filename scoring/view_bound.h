#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scoring/cover_bound.h"
#include "scoring/pose_cover.h"

namespace nextview {

/// How few views and metres a share of surface coverage takes; all over the sampled poses, and all
/// with the scan at the start as first view.
struct ViewBound {
  double share = 0.0;     ///< of surface coverage
  bool reached = false;   ///< by all poses together; else the rest means nothing
  int greedy_views = 0;   ///< of the greedy that knows the scene
  double greedy_m = 0.0;  ///< its way along the lattice
  int fewest_views = 0;   ///< no choice of poses takes fewer: 1 + fewest_poses, rounded up
  /// No path is shorter: less than the share can be seen from poses that are all nearer to the
  /// start than this, as the crow flies.
  double shortest_m = 0.0;

  bool operator==(const ViewBound&) const = default;
};

/// Everything the bounds depend on besides the scene.
struct ViewBoundQuestion {
  SensorPose start;
  VisibilityParameters visibility;
  PoseParameters poses;
  std::vector<double> shares = {0.95, 0.99};
};

/// Works the bounds out.
/// @throws CoverageUnknown, and as cover_of_poses
std::vector<ViewBound> view_bounds(const std::string& cache_folder, const Scene& scene,
                                   const std::string& scene_digest,
                                   const ViewBoundQuestion& question,
                                   const std::stop_token& stop = {},
                                   WorkProgress* progress = nullptr);

/// The bounds if they have been worked out before and kept.
std::optional<std::vector<ViewBound>> kept_view_bounds(const std::string& cache_folder,
                                                       const std::string& scene_digest,
                                                       const ViewBoundQuestion& question);
/// @return false when they cannot be kept
bool keep_view_bounds(const std::string& cache_folder, const std::string& scene_digest,
                      const ViewBoundQuestion& question, const std::vector<ViewBound>& bounds);

/// The distance from the start within which poses can cover a share of all weight at best.
double distance_to_cover_m(const CoverSets& sets, const std::vector<double>& nearest_m,
                           double share);

}  // namespace nextview
