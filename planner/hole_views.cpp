#include "planner/hole_views.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <stdexcept>

#include "lcmtypes/parameter_bounds.h"
#include "mapper/integer_line.h"
#include "sensor/elementary_functions.h"

namespace nextview {

namespace {

/// Of a hole's voxels so many, evenly spread, are asked for where it is best looked into.
constexpr std::size_t kAskedOfHole = 12;

/// A position to look from, and what the way there costs.
struct Position {
  VoxelIndex voxel;
  double path_m = 0.0;
  double discount = 1.0;
};

/// What is in sight from one position, found out when it is first asked for: many holes are best
/// looked into from the same.
class SightFrom {
 public:
  SightFrom(const FreeSpaceField& field, const VoxelIndex& position, std::size_t hole_voxels)
      : field_(field), position_(position), known_(hole_voxels, Sight::Unknown) {}

  /// @param number of the voxel among those of all holes
  bool shows(std::size_t number, const VoxelIndex& voxel) {
    Sight& sight = known_[number];
    if (sight == Sight::Unknown) {
      sight = is_in_sight(field_, position_, voxel) ? Sight::Clear : Sight::Blocked;
    }
    return sight == Sight::Clear;
  }

 private:
  enum class Sight : char { Unknown, Clear, Blocked };

  const FreeSpaceField& field_;
  VoxelIndex position_;
  std::vector<Sight> known_;
};

/// A ball around the centres of a hole's voxels, in voxels.
struct Ball {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

Ball ball_around(const SurfaceHole& hole) {
  Eigen::AlignedBox3d box;
  for (const HoleVoxel& voxel : hole.voxels) box.extend(voxel.voxel.cast<double>());
  return {box.center(), 0.5 * box.diagonal().norm()};
}

std::size_t voxels_of(std::span<const SurfaceHole> holes) {
  std::size_t voxels = 0;
  for (const SurfaceHole& hole : holes) voxels += hole.voxels.size();
  return voxels;
}

class ViewFinder {
 public:
  ViewFinder(const FreeSpaceField& field, double voxel_m, std::span<const SurfaceHole> holes,
             const ShortestPaths& paths, std::span<const VoxelIndex> positions,
             const HoleViewParameters& parameters)
      : field_(field), voxel_m_(voxel_m), holes_(holes), parameters_(parameters) {
    for (const SurfaceHole& hole : holes) balls_.push_back(ball_around(hole));
    for (const VoxelIndex& voxel : positions) {
      const double path_m = paths.length_m(voxel);
      positions_.push_back({voxel, path_m, discount(path_m)});
    }
  }

  std::optional<HoleView> view_into(const SurfaceHole& hole) const;
  // Counts what a view shows of all holes.
  void count_all(HoleView& view, SightFrom& sight) const;

 private:
  // What a view from a voxel shows of one of a hole if nothing lies between; 0 when it is too near,
  // too far or too flat.
  double gain(const VoxelIndex& from, const HoleVoxel& voxel) const;
  double discount(double path_m) const {
    return elementary::exp(-parameters_.path_cost_per_m * path_m);
  }
  void aim(HoleView& view, const Eigen::Vector3d& direction) const;
  bool is_in_field(const HoleView& view, const Eigen::Matrix3d& sensor_from_world,
                   const VoxelIndex& voxel) const;

  // Whether one of a hole's voxels may be; most holes are beside the field or too far.
  bool may_be_in_field(const HoleView& view, const Eigen::Vector3d& ahead, const Ball& hole) const;

  const FreeSpaceField& field_;
  double voxel_m_;
  std::span<const SurfaceHole> holes_;
  std::vector<Ball> balls_;  // of the holes
  std::vector<Position> positions_;
  const HoleViewParameters& parameters_;
};

double ViewFinder::gain(const VoxelIndex& from, const HoleVoxel& voxel) const {
  const Eigen::Vector3d out = voxel_m_ * (from - voxel.voxel).cast<double>();
  const double facing_m = out.dot(voxel.outward);
  if (facing_m < 0.0) return 0.0;  // half of them are, and need no distance
  const double distance_m = out.norm();
  if (distance_m < parameters_.range_min_m || distance_m > parameters_.range_max_m) return 0.0;
  const bool has_side = !voxel.outward.isZero();
  if (has_side && facing_m < parameters_.min_cosine * distance_m) return 0.0;
  // Far away the rays go wider apart than the voxels.
  const double hit = std::min(1.0, voxel_m_ / (parameters_.field.spacing_rad * distance_m));
  return voxel.trust * hit * hit;
}

void ViewFinder::aim(HoleView& view, const Eigen::Vector3d& direction) const {
  const double across = elementary::hypot(direction.x(), direction.y());
  view.pan_rad = across > 0.0 ? elementary::atan2(-direction.x(), direction.y()) : 0.0;
  view.tilt_rad = elementary::atan2(direction.z(), across);
}

bool ViewFinder::is_in_field(const HoleView& view, const Eigen::Matrix3d& sensor_from_world,
                             const VoxelIndex& voxel) const {
  const Eigen::Vector3d towards = (voxel - view.voxel).cast<double>().normalized();
  return parameters_.field.contains(sensor_from_world * towards);
}

std::optional<HoleView> ViewFinder::view_into(const SurfaceHole& hole) const {
  std::vector<const HoleVoxel*> asked;
  const std::size_t step = (hole.voxels.size() + kAskedOfHole - 1) / kAskedOfHole;
  for (std::size_t i = 0; i < hole.voxels.size(); i += step) asked.push_back(&hole.voxels[i]);
  double trust = 0.0;
  for (const HoleVoxel* voxel : asked) trust += voxel->trust;
  std::optional<HoleView> best;
  std::vector<double> shown(asked.size());
  for (const auto& [position, path_m, discount] : positions_) {
    // Most positions are too far, and of most others need not be looked from.
    const double to_beat = best ? best->score : 0.0;
    if (trust * discount <= to_beat) continue;
    double most = 0.0;
    for (std::size_t i = 0; i < asked.size(); ++i) most += shown[i] = gain(position, *asked[i]);
    if (most * discount <= to_beat) continue;
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
    view.score = view.gain_voxels * discount;
    if (view.score > to_beat) best = view;
  }
  return best;
}

bool ViewFinder::may_be_in_field(const HoleView& view, const Eigen::Vector3d& ahead,
                                 const Ball& hole) const {
  constexpr double kRounding = 1e-6;
  const Eigen::Vector3d towards = hole.center - view.voxel.cast<double>();
  const double distance = towards.norm();
  if (voxel_m_ * (distance - hole.radius) > parameters_.range_max_m + kRounding) return false;
  if (distance <= hole.radius) return true;
  const double aside_rad = elementary::acos(std::clamp(ahead.dot(towards) / distance, -1.0, 1.0));
  const double half_width_rad =
      elementary::acos(std::clamp(parameters_.field.least_ahead, -1.0, 1.0));
  return aside_rad <= half_width_rad + elementary::asin(hole.radius / distance) + kRounding;
}

void ViewFinder::count_all(HoleView& view, SightFrom& sight) const {
  const Eigen::Matrix3d sensor_from_world =
      world_from_sensor_rotation(view.pan_rad, view.tilt_rad).transpose();
  view.gain_voxels = 0.0;
  const Eigen::Vector3d ahead = sensor_from_world.row(1);  // the optical axis
  std::size_t first = 0;                                   // number of the hole's first voxel
  for (std::size_t i = 0; i < holes_.size(); first += holes_[i++].voxels.size()) {
    if (!may_be_in_field(view, ahead, balls_[i])) continue;
    for (std::size_t j = 0; j < holes_[i].voxels.size(); ++j) {
      const HoleVoxel& voxel = holes_[i].voxels[j];
      const double shown = gain(view.voxel, voxel);
      if (shown <= 0.0 || !is_in_field(view, sensor_from_world, voxel.voxel)) continue;
      if (!sight.shows(first + j, voxel.voxel)) continue;
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
  const ViewFinder finder(field, voxel_m, holes, paths, positions, parameters);
  const std::size_t hole_voxels = voxels_of(holes);
  std::vector<HoleView> views;
  for (std::size_t i = 0; i < holes.size(); ++i) {
    auto view = finder.view_into(holes[i]);
    if (!view) continue;
    view->hole = i;
    views.push_back(*std::move(view));
  }
  std::ranges::stable_sort(views, std::ranges::greater(), &HoleView::score);
  if (views.size() > kMostHoleViews) views.resize(kMostHoleViews);
  std::map<std::array<int, 3>, SightFrom> sights;  // by the position looked from
  for (HoleView& view : views) {
    const std::array<int, 3> from = {view.voxel.x(), view.voxel.y(), view.voxel.z()};
    finder.count_all(view, sights.try_emplace(from, field, view.voxel, hole_voxels).first->second);
  }
  std::ranges::stable_sort(views, std::ranges::greater(), &HoleView::score);
  return views;
}

}  // namespace nextview
