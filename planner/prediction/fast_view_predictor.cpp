#include "planner/prediction/fast_view_predictor.h"

#include <omp.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "lcmtypes/parameter_bounds.h"
#include "planner/prediction/view_packets.h"

namespace nextview {

namespace {

constexpr std::size_t kPacketRays = RayBundle::kPacketRays;

/// What a thread takes from a table at a time when there are several: a few microseconds of work.
constexpr std::size_t kPortion = 64;

}  // namespace

FastViewPredictor::FastViewPredictor(const PredictionRaster& raster, double voxel_size_m,
                                     std::vector<Orientation> orientations, bool counts_surfaces,
                                     int threads)
    : RasterViewPredictor(raster, voxel_size_m, std::move(orientations), counts_surfaces),
      rays_per_view_(static_cast<std::int64_t>(raster.rays.pixels())),
      packets_of_(this->orientations().size()),
      workspaces_(static_cast<std::size_t>(std::max(threads, 1))) {
  bounds::kThreads.require(threads);
  make_tables(raster, voxel_size_m);
}

void FastViewPredictor::make_tables(const PredictionRaster& raster, double voxel_size_m) {
  std::array<std::vector<RayPacket>, 6> packets;
  for (std::size_t i = 0; i < orientations().size(); ++i) {
    const auto of_view = packets_of(raster.rays, orientations()[i], static_cast<std::int32_t>(i),
                                    prediction_reach(raster, voxel_size_m));
    for (std::size_t table = 0; table < packets.size(); ++table) {
      packets[table].insert(packets[table].end(), of_view[table].begin(), of_view[table].end());
    }
  }
  for (std::size_t i = 0; i < tables_.size(); ++i) {
    std::stable_sort(packets[i].begin(), packets[i].end(),
                     [](const RayPacket& a, const RayPacket& b) { return a.place() < b.place(); });
    Table& table = tables_[i];
    table.bundle.driving_axis = static_cast<int>(i / 2);
    table.bundle.direction = i % 2 == 0 ? 1 : -1;
    for (const RayPacket& packet : packets[i]) {
      append(packet, table.bundle);
      if (!counts_surfaces()) continue;
      packets_of_[static_cast<std::size_t>(packet.orientation)].push_back(
          {i, table.bundle.packets.size() - 1});
      for (const TabulatedRay& ray : packet.rays) table.directions.push_back(ray.direction);
    }
    if (counts_surfaces()) table.occupied_at.resize(table.bundle.rays());
  }
}

void FastViewPredictor::predict(const KnownSpace& space, const VoxelIndex& sensor,
                                std::span<ViewCounts> per_orientation) {
  predict_all(space, {&sensor, 1}, per_orientation);
}

void FastViewPredictor::predict_all(const KnownSpace& space, std::span<const VoxelIndex> sensors,
                                    std::span<ViewCounts> counts) {
  const std::size_t views = orientations().size();
  check_count(sensors.size(), counts.size());
  for (const VoxelIndex& sensor : sensors) check_arguments(space.map(), sensor, views);
  std::fill(counts.begin(), counts.end(), ViewCounts());
  // The tables remember what the rays of one sensor met.
  const std::size_t together = counts_surfaces() ? 1 : sensors.size();
  for (std::size_t i = 0; i < sensors.size(); i += together) {
    predict_together(space, sensors.subspan(i, together),
                     counts.subspan(i * views, together * views));
  }
}

void FastViewPredictor::fill_queues(std::size_t jobs) {
  if (queues_.size() < jobs) queues_ = std::vector<PacketQueue>(jobs);
  for (std::size_t job = 0; job < jobs; ++job) {
    const std::size_t packets = tables_[job % tables_.size()].bundle.packets.size();
    queues_[job].refill(packets, threads() == 1 ? packets : kPortion);
  }
}

void FastViewPredictor::predict_together(const KnownSpace& space,
                                         std::span<const VoxelIndex> sensors,
                                         std::span<ViewCounts> counts) {
  const SurfaceTable* const surfaces = counts_surfaces() ? &space.surfaces() : nullptr;
  fill_queues(sensors.size() * tables_.size());
  std::size_t team = 1;  // there can be fewer threads than were asked for
#pragma omp parallel num_threads(threads()) if (threads() > 1)
  {
#pragma omp master
    team = static_cast<std::size_t>(omp_get_num_threads());
    const auto thread = static_cast<std::size_t>(omp_get_thread_num());
    Workspace& workspace = workspaces_[thread];
    workspace.counts.assign(counts.size(), RayCounts());
    do_jobs(space.field(), sensors, thread, workspace);
    if (surfaces != nullptr) {
#pragma omp barrier
#pragma omp for schedule(dynamic)
      for (std::size_t i = 0; i < counts.size(); ++i) {
        count_surfaces(*surfaces, i, workspace, counts[i]);
      }
    }
  }
  add_up(std::span(workspaces_).first(team), counts);
}

void FastViewPredictor::do_jobs(const FreeSpaceField& field, std::span<const VoxelIndex> sensors,
                                std::size_t thread, Workspace& workspace) {
  const std::size_t views = orientations().size();
  const std::size_t jobs = sensors.size() * tables_.size();
  const std::size_t first = first_job(thread, jobs);
  for (std::size_t i = 0; i < jobs; ++i) {
    const std::size_t job = (first + i) % jobs;
    const std::size_t sensor = job / tables_.size();
    if (queues_[job].empty()) continue;
    cast(field, tables_[job % tables_.size()], queues_[job], sensors[sensor],
         &workspace.counts[sensor * views]);
  }
}

void FastViewPredictor::add_up(std::span<const Workspace> workspaces,
                               std::span<ViewCounts> counts) const {
  for (std::size_t i = 0; i < counts.size(); ++i) {
    ViewCounts& view = counts[i];
    for (const Workspace& workspace : workspaces) {
      view.occupied += workspace.counts[i].occupied;
      view.occlusion_plane += workspace.counts[i].occlusion_plane;
      view.unseen += workspace.counts[i].unseen;
    }
    view.open = rays_per_view_ - view.occupied - view.occlusion_plane - view.unseen;
  }
}

void FastViewPredictor::cast(const FreeSpaceField& field, Table& table, PacketQueue& queue,
                             const VoxelIndex& sensor, RayCounts* counts) const {
  RayOutcomes outcomes;
  outcomes.counts = counts;
  if (counts_surfaces()) outcomes.occupied_at = table.occupied_at.data();
  cast_bundle(field.bytes(), field.shifts(), static_cast<std::int32_t>(field.offset(sensor)),
              field.steps_from(sensor), table.bundle, queue, outcomes);
}

void FastViewPredictor::count_surfaces(const SurfaceTable& surfaces, std::size_t orientation,
                                       Workspace& workspace, ViewCounts& counts) const {
  for (const auto& [number, packet] : packets_of_[orientation]) {
    const std::int32_t* const occupied_at = &tables_[number].occupied_at[packet * kPacketRays];
    const QuantisedDirection* const rays = &tables_[number].directions[packet * kPacketRays];
    for (std::size_t i = 0; i < kPacketRays; ++i) {
      if (occupied_at[i] < 0) continue;
      const std::uint32_t surface = surfaces.number_at(static_cast<std::size_t>(occupied_at[i]));
      workspace.surfaces.add(surface, quantised_cosine(surfaces[surface].normal, rays[i]));
    }
  }
  workspace.surfaces.finish(surfaces, counts);
}

}  // namespace nextview
