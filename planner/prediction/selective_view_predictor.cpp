#include "planner/prediction/selective_view_predictor.h"

#include <omp.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "lcmtypes/parameter_bounds.h"
#include "planner/prediction/view_packets.h"

namespace nextview {

SelectiveViewPredictor::SelectiveViewPredictor(const PredictionRaster& raster, double voxel_size_m,
                                               std::vector<Orientation> orientations,
                                               bool counts_surfaces, int threads)
    : RasterViewPredictor(raster, voxel_size_m, std::move(orientations), counts_surfaces),
      raster_(raster),
      reach_(prediction_reach(raster, voxel_size_m)),
      tables_(this->orientations().size()),
      all_(this->orientations().size()),
      workspaces_(static_cast<std::size_t>(std::max(threads, 1))) {
  bounds::kThreads.require(threads);
  std::iota(all_.begin(), all_.end(), std::size_t{0});
}

std::size_t SelectiveViewPredictor::tabulated() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(tables_, [](const auto& tables) { return tables != nullptr; }));
}

SelectiveViewPredictor::Tables SelectiveViewPredictor::tables_of(std::size_t orientation) const {
  // A view is counted by itself, in the first group.
  const auto packets = packets_of(raster_.rays, orientations()[orientation], 0, reach_);
  Tables tables;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    if (packets[i].empty()) continue;
    Table& table = tables.emplace_back();
    table.bundle.driving_axis = static_cast<int>(i / 2);
    table.bundle.direction = i % 2 == 0 ? 1 : -1;
    table.bundle.packets.reserve(packets[i].size());
    for (const RayPacket& packet : packets[i]) {
      append(packet, table.bundle);
      if (!counts_surfaces()) continue;
      for (const TabulatedRay& ray : packet.rays) table.directions.push_back(ray.direction);
    }
  }
  return tables;
}

void SelectiveViewPredictor::predict(const KnownSpace& space, const VoxelIndex& sensor,
                                     std::span<ViewCounts> per_orientation) {
  check_arguments(space.map(), sensor, per_orientation.size());
  look_from(space, sensor);
  count(all_, per_orientation);
}

void SelectiveViewPredictor::look_from(const KnownSpace& space, const VoxelIndex& sensor) {
  check_arguments(space.map(), sensor, orientations().size());
  if (counts_surfaces()) space.surfaces();  // throws unless they are kept
  space_ = &space;
  sensor_ = sensor;
}

void SelectiveViewPredictor::count(std::span<const std::size_t> which,
                                   std::span<ViewCounts> counts) {
  check_asked(which.size(), counts.size());
  for (const std::size_t orientation : which) {
    auto& tables = tables_.at(orientation);
    if (tables == nullptr) tables = std::make_unique<Tables>(tables_of(orientation));
  }
  const auto threads = static_cast<int>(workspaces_.size());
#pragma omp parallel for schedule(dynamic) num_threads(threads) if (threads > 1)
  for (std::size_t i = 0; i < which.size(); ++i) {
    const auto thread = static_cast<std::size_t>(omp_get_thread_num());
    counts[i] = count_view(*tables_[which[i]], workspaces_[thread]);
  }
}

ViewCounts SelectiveViewPredictor::count_view(const Tables& tables, Workspace& workspace) const {
  const FreeSpaceField& field = space_->field();
  const SurfaceTable* const surfaces = counts_surfaces() ? &space_->surfaces() : nullptr;
  RayCounts met;
  ViewCounts counts;
  for (const Table& table : tables) {
    RayOutcomes outcomes;
    outcomes.counts = &met;
    if (surfaces != nullptr) {
      workspace.occupied_at.resize(table.bundle.rays());
      outcomes.occupied_at = workspace.occupied_at.data();
    }
    workspace.queue.refill(table.bundle.packets.size(), table.bundle.packets.size());
    cast_bundle(field.bytes(), field.shifts(), static_cast<std::int32_t>(field.offset(sensor_)),
                field.steps_from(sensor_), table.bundle, workspace.queue, outcomes);
    if (surfaces == nullptr) continue;
    for (std::size_t ray = 0; ray < table.directions.size(); ++ray) {
      if (workspace.occupied_at[ray] < 0) continue;
      const auto offset = static_cast<std::size_t>(workspace.occupied_at[ray]);
      const std::uint32_t surface = surfaces->number_at(offset);
      workspace.surfaces.add(surface,
                             quantised_cosine((*surfaces)[surface].normal, table.directions[ray]));
    }
  }
  if (surfaces != nullptr) workspace.surfaces.finish(*surfaces, counts);
  counts.occupied = met.occupied;
  counts.occlusion_plane = met.occlusion_plane;
  counts.unseen = met.unseen;
  counts.open = static_cast<std::int64_t>(raster_.rays.pixels()) - counts.occupied -
                counts.occlusion_plane - counts.unseen;
  return counts;
}

}  // namespace nextview
