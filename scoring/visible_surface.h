#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "scoring/reachable_positions.h"
#include "scoring/work_progress.h"

namespace nextview {

/// What could be seen, of which surface, from where.
struct VisibilityParameters {
  ReachParameters reach;
  double range_max_m = 30.0;  ///< of the sensor
  double samples_per_m2 = 400.0;
  std::int64_t most_samples = 500'000;  ///< of a larger surface there are fewer a square metre
};

/// The surface a run could see at best; what it did see is held against it.
struct VisibleSurface {
  std::vector<Eigen::Vector3f> points_m;  ///< samples that can be seen, world frame
  std::int64_t samples = 0;               ///< seen or not
  std::int64_t positions = 0;             ///< looked from
  double samples_per_m2 = 0.0;            ///< fewer than asked for when the surface is too large

  /// In m^2, one side of every triangle.
  double area_m2() const { return static_cast<double>(points_m.size()) / samples_per_m2; }
};

/// Samples of the surface that can be seen in range from a position that can be reached from the
/// start: independent of anything scanned, and of where in the same free space the start lies.
///
/// Exact: each sample against every position of the lattice (see reachable_positions). What comes
/// back when stop is requested is incomplete and to be thrown away.
/// @throws CoverageUnknown when no position can be reached, or too many
VisibleSurface visible_surface(const Scene& scene, const Eigen::Vector3d& start_m,
                               const VisibilityParameters& parameters,
                               const std::stop_token& stop = {}, WorkProgress* progress = nullptr);

/// The same, kept in a folder under the scene's digest, the parameters and the positions reached,
/// and read from there the next time. What is kept but damaged is worked out again and replaced. An
/// empty folder keeps nothing.
/// @param folder is made if it is not there; when it cannot be written to nothing is kept
VisibleSurface kept_visible_surface(const std::string& folder, const Scene& scene,
                                    const std::string& scene_digest, const Eigen::Vector3d& start_m,
                                    const VisibilityParameters& parameters,
                                    const std::stop_token& stop = {},
                                    WorkProgress* progress = nullptr);

/// That of the function above if it has been kept; else nothing. Finds the positions, no more.
/// @throws CoverageUnknown as above
std::optional<VisibleSurface> visible_surface_if_kept(const std::string& folder, const Scene& scene,
                                                      const std::string& scene_digest,
                                                      const Eigen::Vector3d& start_m,
                                                      const VisibilityParameters& parameters);

}  // namespace nextview
