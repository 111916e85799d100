#include "planner/fast_view_predictor.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "sensor_sim/sensor_pose.h"

namespace nextview {

namespace {

// All pixels, tile by tile: the rays of a vector should end at about the same time, so they should
// be neighbours both ways.
std::vector<std::array<int, 2>> tiled_pixels(const RayTable& rays) {
  constexpr int kTile = 4;
  std::vector<std::array<int, 2>> pixels;
  pixels.reserve(rays.pixels());
  for (int v0 = 0; v0 < rays.rows(); v0 += kTile) {
    for (int u0 = 0; u0 < rays.columns(); u0 += kTile) {
      for (int v = v0; v < std::min(v0 + kTile, rays.rows()); ++v) {
        for (int u = u0; u < std::min(u0 + kTile, rays.columns()); ++u) pixels.push_back({u, v});
      }
    }
  }
  return pixels;
}

void append(RayBundle& bundle, const IntegerLine& line, int ray) {
  bundle.slope1.push_back(line.slope[(line.driving_axis + 1) % 3]);
  bundle.slope2.push_back(line.slope[(line.driving_axis + 2) % 3]);
  bundle.reach.push_back(line.steps);
  bundle.ray.push_back(ray);
}

// Fills a bundle up with copies of its last ray that reach nowhere.
void pad(RayBundle& bundle) {
  while (bundle.size() % kBundleGranularity != 0) {
    bundle.slope1.push_back(bundle.slope1.back());
    bundle.slope2.push_back(bundle.slope2.back());
    bundle.reach.push_back(-1);
    bundle.ray.push_back(-1);
    ++bundle.padding;
  }
}

}  // namespace

FastViewPredictor::FastViewPredictor(const PredictionRaster& raster, double voxel_size_m,
                                     std::vector<Orientation> orientations, bool counts_quality,
                                     int threads)
    : RasterViewPredictor(raster, voxel_size_m, std::move(orientations), counts_quality),
      arena_(std::max(threads, 1)),
      workspaces_(static_cast<std::size_t>(std::max(threads, 1))) {
  if (threads < 1) throw std::invalid_argument("a view predictor needs a thread");
  const double reach = prediction_reach(raster, voxel_size_m);
  for (const Orientation& orientation : this->orientations()) {
    views_.push_back(make_view(raster.rays, orientation, reach));
  }
}

FastViewPredictor::View FastViewPredictor::make_view(const RayTable& rays,
                                                     const Orientation& orientation,
                                                     double reach) const {
  const Eigen::Matrix3d rotation =
      world_from_sensor_rotation(orientation.pan_rad, orientation.tilt_rad);
  View view;
  std::array<RayBundle, 6> bundles;  // by driving axis and sign
  for (const auto& [u, v] : tiled_pixels(rays)) {
    const Eigen::Vector3d direction = rotation * rays.ray(u, v);
    const IntegerLine line = line_along(VoxelIndex::Zero(), direction, reach);
    const auto bundle = static_cast<std::size_t>(2 * line.driving_axis + (line.direction < 0));
    append(bundles[bundle], line, static_cast<int>(view.directions.size()));
    view.directions.push_back(quantise_direction(direction));
  }
  for (RayBundle& bundle : bundles) {
    bundle.driving_axis = static_cast<int>(&bundle - bundles.data()) / 2;
    bundle.direction = (&bundle - bundles.data()) % 2 == 0 ? 1 : -1;
    if (bundle.size() == 0) continue;
    pad(bundle);
    view.bundles.push_back(std::move(bundle));
  }
  return view;
}

void FastViewPredictor::prepare(const VoxelMap& map) {
  if (field_ && field_->window() == map.window()) return;
  field_.emplace(map);
  surfaces_ = SurfaceTable();
  if (!counts_quality()) return;
  std::vector<std::uint32_t> slots;
  for (std::size_t slot = 0; slot < map.labels().size(); ++slot) {
    if (map.labels()[slot] == Label::Occupied) slots.push_back(static_cast<std::uint32_t>(slot));
  }
  surfaces_.update(map, *field_, slots);
}

void FastViewPredictor::map_changed(const VoxelMap& map,
                                    std::span<const std::uint32_t> changed_slots,
                                    std::span<const std::uint32_t> updated_surfaces) {
  if (!field_ || field_->window() != map.window()) {
    prepare(map);
    return;
  }
  field_->update(map, changed_slots);
  if (!counts_quality()) return;
  // A voxel may become Occupied by points that had no normal, and so without surface data.
  surfaces_.update(map, *field_, changed_slots);
  surfaces_.update(map, *field_, updated_surfaces);
}

void FastViewPredictor::predict(const VoxelMap& map, const VoxelIndex& sensor,
                                std::span<ViewCounts> per_orientation) {
  check_arguments(map, sensor, per_orientation.size());
  prepare(map);
  const auto start = static_cast<std::int32_t>(field_->offset(sensor));
  const int jump = field_->at(sensor) - FreeSpaceField::kJump;
  const std::int32_t first_k = std::max(jump, 1);
  const auto predict_some = [&](std::size_t begin, std::size_t end, Workspace& workspace) {
    for (std::size_t i = begin; i < end; ++i) {
      per_orientation[i] = predict_view(views_[i], start, first_k, workspace);
    }
  };
  if (workspaces_.size() == 1) {
    predict_some(0, views_.size(), workspaces_.front());
    return;
  }
  arena_.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, views_.size()), [&](const auto& range) {
      const auto thread = static_cast<std::size_t>(tbb::this_task_arena::current_thread_index());
      predict_some(range.begin(), range.end(), workspaces_[thread]);
    });
  });
}

ViewCounts FastViewPredictor::predict_view(const View& view, std::int32_t start,
                                           std::int32_t first_k, Workspace& workspace) const {
  ViewCounts counts;
  for (const RayBundle& bundle : view.bundles) {
    RayEnds ends;
    if (counts_quality()) {
      workspace.met.resize(static_cast<std::size_t>(bundle.size()));
      ends.occupied_at = workspace.met.data();
    }
    const RayCounts rays =
        cast_bundle(field_->bytes(), field_->shifts(), start, first_k, bundle, ends);
    counts.occupied += rays.occupied;
    counts.occlusion_plane += rays.occlusion_plane;
    counts.unseen += rays.unseen;
    counts.open +=
        bundle.size() - bundle.padding - rays.occupied - rays.occlusion_plane - rays.unseen;
    if (!counts_quality()) continue;
    for (std::size_t i = 0; i < workspace.met.size(); ++i) {
      if (workspace.met[i] < 0) continue;
      const std::uint32_t surface = surfaces_.number_at(static_cast<std::size_t>(workspace.met[i]));
      const auto ray = static_cast<std::size_t>(bundle.ray[i]);
      workspace.improvement.add(surface,
                                quantised_cosine(surfaces_[surface].normal, view.directions[ray]));
    }
  }
  if (counts_quality()) workspace.improvement.finish(surfaces_, counts);
  return counts;
}

}  // namespace nextview
