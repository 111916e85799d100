#include "scoring/pose_cover.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>

#include "lcmtypes/parameter_bounds.h"
#include "planner/prediction/orientations.h"
#include "scoring/on_all_cores.h"
#include "sensor_sim/scan.h"

namespace nextview {
namespace {

/// The voxels that hold visible samples, numbered.
class SampledVoxels {
 public:
  SampledVoxels(const VoxelGrid& grid, const VisibleSurface& surface) : grid_(grid) {
    VoxelIndex min = VoxelIndex::Constant(std::numeric_limits<int>::max());
    VoxelIndex max = VoxelIndex::Constant(std::numeric_limits<int>::min());
    for (const Eigen::Vector3f& point : surface.points_m) {
      const VoxelIndex voxel = grid_.voxel_of(point.cast<double>());
      min = min.cwiseMin(voxel);
      max = max.cwiseMax(voxel);
    }
    if (surface.points_m.empty()) return;
    window_ = {min, max - min + VoxelIndex::Ones()};
    numbers_.assign(static_cast<std::size_t>(window_.size.cast<std::int64_t>().prod()), -1);
    for (const Eigen::Vector3f& point : surface.points_m) {
      std::int32_t& number = numbers_[at(grid_.voxel_of(point.cast<double>()))];
      if (number < 0) {
        number = static_cast<std::int32_t>(weights_.size());
        weights_.push_back(0);
      }
      ++weights_[static_cast<std::size_t>(number)];
    }
  }

  const std::vector<std::uint32_t>& weights() const { return weights_; }
  /// Negative where there are no samples.
  std::int32_t number_of(const Eigen::Vector3d& point_m) const {
    const VoxelIndex voxel = grid_.voxel_of(point_m);
    return window_.contains(voxel) ? numbers_[at(voxel)] : -1;
  }

 private:
  std::size_t at(const VoxelIndex& voxel) const {
    const auto offset = (voxel - window_.min).cast<std::size_t>().eval();
    const auto size = window_.size.cast<std::size_t>().eval();
    return (offset.z() * size.y() + offset.y()) * size.x() + offset.x();
  }

  VoxelGrid grid_;
  MapWindow window_ = {VoxelIndex::Zero(), VoxelIndex::Zero()};
  std::vector<std::int32_t> numbers_;  ///< by voxel of the window
  std::vector<std::uint32_t> weights_;
};

/// For each multiple of the spacing that has one near, the nearest of the positions.
std::vector<Eigen::Vector3d> at_spacing(const std::vector<Eigen::Vector3d>& positions,
                                        double spacing_m) {
  struct Nearest {
    double distance_m;
    Eigen::Vector3d position_m;
  };
  std::map<std::tuple<int, int, int>, Nearest> nearest;
  for (const Eigen::Vector3d& position : positions) {
    const Eigen::Vector3i multiple = (position.array() / spacing_m).round().cast<int>();
    const double distance_m = (position - spacing_m * multiple.cast<double>()).norm();
    if (distance_m > 0.5 * spacing_m) continue;  // nearer to none of them
    const auto [at, is_new] = nearest.try_emplace(
        std::tuple(multiple.z(), multiple.y(), multiple.x()), Nearest{distance_m, position});
    if (!is_new && distance_m < at->second.distance_m) at->second = {distance_m, position};
  }
  std::vector<Eigen::Vector3d> chosen;
  chosen.reserve(nearest.size());
  for (const auto& [multiple, best] : nearest) chosen.push_back(best.position_m);
  return chosen;
}

/// Finds what a pose covers; one a thread.
class CoverFinder {
 public:
  CoverFinder(const Scene& scene, const RayTable& rays, const PoseParameters& parameters,
              const SampledVoxels& voxels)
      : scene_(&scene),
        rays_(&rays),
        limits_(parameters.limits),
        baseline_m_(baseline_m_of(parameters.sensor)),
        voxels_(&voxels),
        seen_in_(voxels.weights().size(), 0) {}

  std::vector<std::uint32_t> covered_from(const SensorPose& pose) {
    ++call_;
    std::vector<std::uint32_t> covered;
    const RangeImage image = scan(*scene_, *rays_, limits_, pose, 0.0, no_noise_, baseline_m_);
    std::size_t pixel = 0;
    for (int v = 0; v < rays_->rows(); ++v) {
      for (int u = 0; u < rays_->columns(); ++u) {
        const double range_m = static_cast<double>(image.range_m[pixel++]);
        if (!std::isfinite(range_m)) continue;
        const std::int32_t number = voxels_->number_of(
            image.position_m + range_m * (image.world_from_sensor * rays_->ray(u, v)));
        if (number < 0 || seen_in_[static_cast<std::size_t>(number)] == call_) continue;
        seen_in_[static_cast<std::size_t>(number)] = call_;
        covered.push_back(static_cast<std::uint32_t>(number));
      }
    }
    std::sort(covered.begin(), covered.end());
    return covered;
  }

 private:
  const Scene* scene_;
  const RayTable* rays_;
  RangeLimits limits_;
  double baseline_m_;
  const SampledVoxels* voxels_;
  RandomStream no_noise_{0, 0, 0, RandomPurpose::RangeNoise};
  std::vector<std::uint32_t> seen_in_;  ///< by voxel: the last call that met it
  std::uint32_t call_ = 0;
};

}  // namespace

void PoseParameters::check() const { bounds::kBoundSpacing.require(spacing_m); }

PoseCover cover_of_poses(const Scene& scene, const SensorPose& start,
                         const std::vector<Eigen::Vector3d>& reachable,
                         const VisibleSurface& surface, const PoseParameters& parameters,
                         const std::stop_token& stop, WorkProgress* progress) {
  parameters.check();
  PoseCover cover;
  cover.poses.push_back(start);
  const std::vector<Orientation> orientations = icosahedron_orientations(parameters.subdivisions);
  for (const Eigen::Vector3d& position : at_spacing(reachable, parameters.spacing_m)) {
    for (const Orientation& orientation : orientations) {
      cover.poses.push_back({position, orientation.pan_rad, orientation.tilt_rad});
    }
  }
  const SampledVoxels voxels(parameters.grid, surface);
  cover.sets.weights = voxels.weights();
  cover.nearest_m.assign(voxels.weights().size(), std::numeric_limits<double>::infinity());

  WorkProgress unwatched;
  if (progress == nullptr) progress = &unwatched;
  progress->begin("scans from all poses", static_cast<std::int64_t>(cover.poses.size()));
  const RayTable rays = make_ray_table(parameters.sensor);
  constexpr std::size_t kPosesAtATime = 8192;
  std::vector<std::vector<std::uint32_t>> covered;
  for (std::size_t first = 0; first < cover.poses.size(); first += kPosesAtATime) {
    covered.assign(std::min(kPosesAtATime, cover.poses.size() - first), {});
    std::atomic<std::size_t> next = 0;
    on_all_cores([&] {
      CoverFinder finder(scene, rays, parameters, voxels);
      for (std::size_t i = next++; i < covered.size() && !stop.stop_requested(); i = next++) {
        covered[i] = finder.covered_from(cover.poses[first + i]);
        ++progress->done;
      }
    });
    if (stop.stop_requested()) return cover;
    for (std::size_t i = 0; i < covered.size(); ++i) {
      const double distance_m = (cover.poses[first + i].position_m - start.position_m).norm();
      for (const std::uint32_t voxel : covered[i]) {
        cover.nearest_m[voxel] = std::min(cover.nearest_m[voxel], distance_m);
      }
      cover.sets.add_pose(covered[i]);
    }
    if (cover.sets.bytes() > parameters.most_bytes) {
      throw std::invalid_argument(
          "the scene holds too many poses to look at: give a larger --bound-spacing");
    }
  }
  return cover;
}

}  // namespace nextview
