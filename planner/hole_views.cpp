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
  ViewFinder(const FreeSpaceField& field, double voxel_m, const ShortestPaths& paths,
             const HoleViewParameters& parameters)
      : field_(field), voxel_m_(voxel_m), paths_(paths), parameters_(parameters) {}

  std::optional<HoleView> view_into(const SurfaceHole& hole,
                                    std::span<const VoxelIndex> positions) const;
  // Counts what a view shows of all holes.
  void count_all(HoleView& view, std::span<const SurfaceHole> holes) const;

 private:
  // What a view from a voxel shows of one of a hole if nothing lies between; 0 when it is too near,
  // too far or too flat.
  double gain(const VoxelIndex& from, const HoleVoxel& voxel) const;
  double discount(double path_m) const { return std::exp(-parameters_.path_cost_per_m * path_m); }
  void aim(HoleView& view, const Eigen::Vector3d& direction) const;
  bool is_in_field(const HoleView& view, const Eigen::Matrix3d& sensor_from_world,
                   const VoxelIndex& voxel) const;

  const FreeSpaceField& field_;
  double voxel_m_;
  const ShortestPaths& paths_;
  const HoleViewParameters& parameters_;
};

double ViewFinder::gain(const VoxelIndex& from, const HoleVoxel& voxel) const {
  const Eigen::Vector3d out = voxel_m_ * (from - voxel.voxel).cast<double>();
  const double distance_m = out.norm();
  if (distance_m < parameters_.range_min_m || distance_m > parameters_.range_max_m) return 0.0;
  const bool has_side = !voxel.outward.isZero();
  if (has_side && out.dot(voxel.outward) < parameters_.min_cosine * distance_m) return 0.0;
  // Far away the rays go wider apart than the voxels.
  const double hit = std::min(1.0, voxel_m_ / (parameters_.field.spacing_rad * distance_m));
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
  std::vector<double> shown(asked.size());
  for (const VoxelIndex& position : positions) {
    double most = 0.0;
    for (std::size_t i = 0; i < asked.size(); ++i) most += shown[i] = gain(position, *asked[i]);
    const double path_m = paths_.length_m(position);
    // Most positions need not be looked from.
    if (most * discount(path_m) <= (best ? best->score : 0.0)) continue;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < asked.size(); ++i) {
      if (shown[i] <= 0.0) continue;
      if (!is_in_sight(field_, position, asked[i]->voxel)) shown[i] = 0.0;
      middle += shown[i] * (asked[i]->voxel - position).cast<double>();
    }
    HoleView view;
    view.voxel = position;
    view.path_m = path_m;
    aim(view, middle);
    const Eigen::Matrix3d sensor_from_world =
        world_from_sensor_rotation(view.pan_rad, view.tilt_rad).transpose();
    for (std::size_t i = 0; i < asked.size(); ++i) {
      if (shown[i] <= 0.0 || !is_in_field(view, sensor_from_world, asked[i]->voxel)) continue;
      view.gain_voxels += shown[i];
    }
    view.score = view.gain_voxels * discount(path_m);
    if (view.score > (best ? best->score : 0.0)) best = view;
  }
  return best;
}

void ViewFinder::count_all(HoleView& view, std::span<const SurfaceHole> holes) const {
  const Eigen::Matrix3d sensor_from_world =
      world_from_sensor_rotation(view.pan_rad, view.tilt_rad).transpose();
  view.gain_voxels = 0.0;
  for (const SurfaceHole& hole : holes) {
    for (const HoleVoxel& voxel : hole.voxels) {
      const double shown = gain(view.voxel, voxel);
      if (shown <= 0.0 || !is_in_field(view, sensor_from_world, voxel.voxel)) continue;
      if (!is_in_sight(field_, view.voxel, voxel.voxel)) continue;
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

bool is_in_sight(const FreeSpaceField& field, const VoxelIndex& from, const VoxelIndex& to) {
  const IntegerLine line = line_between(from, to);
  for (int k = field.steps_from(from); k < line.steps;) {
    const int free = field.free_distance(line.at(k));
    if (free == 0) return false;
    k += free;
  }
  return true;
}

std::vector<HoleView> hole_views(const FreeSpaceField& field, double voxel_m,
                                 std::span<const SurfaceHole> holes, const ShortestPaths& paths,
                                 std::span<const VoxelIndex> positions,
                                 const HoleViewParameters& parameters) {
  parameters.check();
  const ViewFinder finder(field, voxel_m, paths, parameters);
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
