#include "scoring/view_bound.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>

#include "scoring/greedy_cover.h"
#include "scoring/kept_file.h"
#include "scoring/lattice_path.h"

namespace nextview {
namespace {

std::string key_of(const std::string& scene_digest, const ViewBoundQuestion& question) {
  KeptKey key("view bound", 2);
  key.add(scene_digest);
  const auto add = [&key](const Eigen::Vector3d& vector) {
    for (int axis = 0; axis < 3; ++axis) key.add(vector[axis]);
  };
  add(question.start.position_m);
  const ReachParameters& reach = question.visibility.reach;
  add(reach.box_min_m);
  add(reach.box_max_m);
  const PoseParameters& poses = question.poses;
  add(poses.grid.origin_m);
  for (const double value :
       {question.start.pan_rad, question.start.tilt_rad, reach.spacing_m, reach.clearance_m,
        reach.join_within_m, question.visibility.range_max_m, question.visibility.samples_per_m2,
        static_cast<double>(question.visibility.most_samples),
        static_cast<double>(kind_of(poses.sensor)), static_cast<double>(columns_of(poses.sensor)),
        static_cast<double>(rows_of(poses.sensor)), poses.limits.min_m, poses.limits.max_m,
        poses.grid.voxel_size_m, poses.spacing_m, static_cast<double>(poses.subdivisions)}) {
    key.add(value);
  }
  for (const double parameter : parameters_of(poses.sensor)) key.add(parameter);
  for (const double share : question.shares) key.add(share);
  return key.text();
}

double length_of_m(const LatticePaths& paths, const PoseCover& cover,
                   const std::vector<std::size_t>& taken, const std::stop_token& stop) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < taken.size() && !stop.stop_requested(); ++i) {
    length_m +=
        paths.length_m(cover.poses[taken[i - 1]].position_m, cover.poses[taken[i]].position_m);
  }
  return length_m;
}

}  // namespace

double distance_to_cover_m(const CoverSets& sets, const std::vector<double>& nearest_m,
                           double share) {
  std::vector<std::size_t> order(nearest_m.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return nearest_m[a] < nearest_m[b]; });
  const double enough = share * static_cast<double>(sets.total_weight());
  double weight = 0.0;
  for (const std::size_t voxel : order) {
    weight += static_cast<double>(sets.weights[voxel]);
    if (weight >= enough) return nearest_m[voxel];
  }
  return std::numeric_limits<double>::infinity();
}

std::vector<ViewBound> view_bounds(const std::string& cache_folder, const Scene& scene,
                                   const std::string& scene_digest,
                                   const ViewBoundQuestion& question, const std::stop_token& stop,
                                   WorkProgress* progress) {
  const VisibleSurface surface =
      kept_visible_surface(cache_folder, scene, scene_digest, question.start.position_m,
                           question.visibility, stop, progress);
  const ReachParameters& reach = question.visibility.reach;
  const std::vector<Eigen::Vector3d> reachable =
      reachable_positions(scene, question.start.position_m, reach, stop);
  if (stop.stop_requested()) return {};
  const PoseCover cover =
      cover_of_poses(scene, question.start, reachable, surface, question.poses, stop, progress);
  if (stop.stop_requested()) return {};
  const LatticePaths paths(reachable, reach.spacing_m);
  const std::size_t first[] = {0};
  std::vector<ViewBound> bounds;
  for (const double share : question.shares) {
    if (progress != nullptr) progress->begin("greedy", 0);
    ViewBound& bound = bounds.emplace_back();
    bound.share = share;
    const std::vector<std::size_t> greedy = greedy_cover(cover.sets, first, share, stop);
    bound.reached = share_covered(cover.sets, greedy) >= share;
    if (stop.stop_requested() || !bound.reached) continue;
    bound.greedy_views = static_cast<int>(greedy.size());
    bound.greedy_m = length_of_m(paths, cover, greedy, stop);
    const double fewest = fewest_poses(cover.sets, first, share, {}, stop, progress);
    bound.fewest_views = 1 + static_cast<int>(std::ceil(fewest - 1e-6));
    bound.shortest_m = distance_to_cover_m(cover.sets, cover.nearest_m, share);
  }
  return bounds;
}

std::optional<std::vector<ViewBound>> kept_view_bounds(const std::string& cache_folder,
                                                       const std::string& scene_digest,
                                                       const ViewBoundQuestion& question) {
  const auto text = read_kept(cache_folder, key_of(scene_digest, question));
  if (!text) return std::nullopt;
  std::istringstream in(*text);
  std::vector<ViewBound> bounds(question.shares.size());
  for (ViewBound& bound : bounds) {
    in >> bound.share >> bound.reached >> bound.greedy_views >> bound.greedy_m >>
        bound.fewest_views >> bound.shortest_m;
  }
  if (!in) return std::nullopt;
  return bounds;
}

bool keep_view_bounds(const std::string& cache_folder, const std::string& scene_digest,
                      const ViewBoundQuestion& question, const std::vector<ViewBound>& bounds) {
  std::string text;
  for (const ViewBound& bound : bounds) {
    text += fmt::format("{} {:d} {} {} {} {}\n", bound.share, bound.reached, bound.greedy_views,
                        bound.greedy_m, bound.fewest_views, bound.shortest_m);
  }
  return keep(cache_folder, key_of(scene_digest, question), text);
}

}  // namespace nextview
