#include "planner/hole_views.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "lcmtypes/parameter_bounds.h"
#include "mapper/integer_line.h"

namespace nextview {

namespace {

/// Of a hole's voxels so many, evenly spread, are asked for where it is best looked into.
constexpr std::size_t kAskedOfHole = 12;

class ViewFinder {
 public:
  ViewFinder(const VoxelMap& map, const ShortestPaths& paths, const HoleViewParameters& parameters)
      : map_(map), paths_(paths), parameters_(parameters) {}

  std::optional<HoleView> view_into(const SurfaceHole& hole,
                                    std::span<const VoxelIndex> positions) const;
  // Counts what a view shows of all holes.
  void count_all(HoleView& view, std::span<const SurfaceHole> holes) const;

 private:
  // What a view from a voxel shows of one of a hole; 0 when it is not to be seen from there.
  double gain(const VoxelIndex& from, const HoleVoxel& voxel) const;
  double discount(double path_m) const { return std::exp(-parameters_.path_cost_per_m * path_m); }
  void aim(HoleView& view, const Eigen::Vector3d& direction) const;
  bool is_in_field(const HoleView& view, const Eigen::Matrix3d& sensor_from_world,
                   const VoxelIndex& voxel) const;

  const VoxelMap& map_;
  const ShortestPaths& paths_;
  const HoleViewParameters& parameters_;
};

double ViewFinder::gain(const VoxelIndex& from, const HoleVoxel& voxel) const {
  const double voxel_m = map_.grid().voxel_size_m;
  const Eigen::Vector3d out = voxel_m * (from - voxel.voxel).cast<double>();
  const double distance_m = out.norm();
  if (distance_m < parameters_.range_min_m || distance_m > parameters_.range_max_m) return 0.0;
  const bool has_side = !voxel.outward.isZero();
  if (has_side && out.dot(voxel.outward) < parameters_.min_cosine * distance_m) return 0.0;
  if (!is_in_sight(map_, from, voxel.voxel)) return 0.0;
  // Far away the rays go wider apart than the voxels.
  const double hit = std::min(1.0, voxel_m / (parameters_.field.spacing_rad * distance_m));
  return voxel.trust * hit * hit;
}

void ViewFinder::aim(HoleView& view, const Eigen::Vector3d& direction) const {
  const double across = std::hypot(direction.x(), direction.y());
  view.pan_rad = across > 0.0 ? std::atan2(-direction.x(), direction.y()) : 0.0;
  view.tilt_rad = std::atan2(direction.z(), across);
}

bool ViewFinder::is_in_field(const HoleView& view, const Eigen::Matrix3d& sensor_from_world,
                             const VoxelIndex& voxel) const {
  const Eigen::Vector3d towards = (voxel - view.voxel).cast<double>().normalized();
  return parameters_.field.contains(sensor_from_world * towards);
}

std::optional<HoleView> ViewFinder::view_into(const SurfaceHole& hole,
                                              std::span<const VoxelIndex> positions) const {
  std::vector<const HoleVoxel*> asked;
  const std::size_t step = (hole.voxels.size() + kAskedOfHole - 1) / kAskedOfHole;
  for (std::size_t i = 0; i < hole.voxels.size(); i += step) asked.push_back(&hole.voxels[i]);
  std::optional<HoleView> best;
  std::vector<std::pair<const HoleVoxel*, double>> seen;
  for (const VoxelIndex& position : positions) {
    seen.clear();
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const HoleVoxel* voxel : asked) {
      const double shown = gain(position, *voxel);
      if (shown <= 0.0) continue;
      seen.emplace_back(voxel, shown);
      middle += shown * (voxel->voxel - position).cast<double>();
    }
    if (seen.empty()) continue;
    HoleView view;
    view.voxel = position;
    view.path_m = paths_.length_m(position);
    aim(view, middle);
    const Eigen::Matrix3d sensor_from_world =
        world_from_sensor_rotation(view.pan_rad, view.tilt_rad).transpose();
    for (const auto& [voxel, shown] : seen) {
      if (is_in_field(view, sensor_from_world, voxel->voxel)) view.gain_voxels += shown;
    }
    view.score = view.gain_voxels * discount(view.path_m);
    if (view.score > 0.0 && (!best || view.score > best->score)) best = view;
  }
  return best;
}

void ViewFinder::count_all(HoleView& view, std::span<const SurfaceHole> holes) const {
  const Eigen::Matrix3d sensor_from_world =
      world_from_sensor_rotation(view.pan_rad, view.tilt_rad).transpose();
  view.gain_voxels = 0.0;
  for (const SurfaceHole& hole : holes) {
    for (const HoleVoxel& voxel : hole.voxels) {
      if (!is_in_field(view, sensor_from_world, voxel.voxel)) continue;
      const double shown = gain(view.voxel, voxel);
      if (shown <= 0.0) continue;
      view.gain_voxels += shown;
      view.in_sight.push_back(&voxel);
    }
  }
  view.score = view.gain_voxels * discount(view.path_m);
}

}  // namespace

void HoleViewParameters::check() const {
  bounds::kRangeMin.require(range_min_m);
  bounds::kRangeMax.require(range_max_m);
  bounds::kPathCost.require(path_cost_per_m);
  if (!(min_cosine >= 0.0 && min_cosine < 1.0)) {
    throw std::invalid_argument("min_cosine must be in [0, 1)");
  }
  if (!(field.spacing_rad > 0.0)) throw std::invalid_argument("the field of view has no rays");
}

bool is_in_sight(const VoxelMap& map, const VoxelIndex& from, const VoxelIndex& to) {
  const IntegerLine line = line_between(from, to);
  for (int k = 1; k < line.steps; ++k) {
    if (map.label(line.at(k)) != Label::Empty) return false;
  }
  return true;
}

std::vector<HoleView> hole_views(const VoxelMap& map, std::span<const SurfaceHole> holes,
                                 const ShortestPaths& paths, std::span<const VoxelIndex> positions,
                                 const HoleViewParameters& parameters) {
  parameters.check();
  const ViewFinder finder(map, paths, parameters);
  std::vector<HoleView> views;
  for (std::size_t i = 0; i < holes.size(); ++i) {
    if (auto view = finder.view_into(holes[i], positions)) {
      view->hole = i;
      finder.count_all(*view, holes);
      views.push_back(*std::move(view));
    }
  }
  std::ranges::stable_sort(views, std::ranges::greater(), &HoleView::score);
  return views;
}

}  // namespace nextview
