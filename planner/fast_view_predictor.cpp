#include "planner/fast_view_predictor.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "sensor_sim/sensor_pose.h"

namespace nextview {

namespace {

constexpr std::size_t kPacketRays = RayBundle::kPacketRays;

/// What a thread casts at a time: long enough to keep the kernel's turns busy, and short enough
/// that the last to be done is not waited for long.
constexpr std::size_t kPacketsOfPiece = 128;

struct TabulatedRay {
  IntegerLine line;  // from voxel (0, 0, 0)
  QuantisedDirection direction;
  std::uint32_t place;  // along a curve through all directions of its table
};

struct Packet {
  std::int32_t orientation;
  std::array<TabulatedRay, kPacketRays> rays;
  std::size_t count;  // of rays; the others are copies of the last

  std::uint32_t place() const { return rays[count / 2].place; }
};

// The place of a direction along Morton's curve: those that are near each other on it are near each
// other in direction.
std::uint32_t place_of(const IntegerLine& line) {
  constexpr int kBits = 11;
  constexpr int kDropped = IntegerLine::kFractionBits + 1 - kBits;
  std::uint32_t place = 0;
  for (int across = 1; across <= 2; ++across) {
    const std::int32_t slope = line.slope[(line.driving_axis + across) % 3];
    const auto cell =
        static_cast<std::uint32_t>(slope + (1 << IntegerLine::kFractionBits)) >> kDropped;
    for (int bit = 0; bit <= kBits; ++bit) place |= (cell >> bit & 1) << (2 * bit + across - 1);
  }
  return place;
}

// The rays of an orientation, by driving axis and sign, and in packets of neighbours.
std::array<std::vector<Packet>, 6> packets_of(const RayTable& rays, const Orientation& orientation,
                                              std::int32_t number, double reach) {
  const Eigen::Matrix3d rotation =
      world_from_sensor_rotation(orientation.pan_rad, orientation.tilt_rad);
  std::array<std::vector<TabulatedRay>, 6> tabulated;
  for (int v = 0; v < rays.rows(); ++v) {
    for (int u = 0; u < rays.columns(); ++u) {
      const Eigen::Vector3d direction = rotation * rays.ray(u, v);
      const IntegerLine line = line_along(VoxelIndex::Zero(), direction, reach);
      tabulated[static_cast<std::size_t>(2 * line.driving_axis + (line.direction < 0))].push_back(
          {line, quantise_direction(direction), place_of(line)});
    }
  }
  std::array<std::vector<Packet>, 6> packets;
  for (std::size_t table = 0; table < tabulated.size(); ++table) {
    auto& sorted = tabulated[table];
    std::stable_sort(
        sorted.begin(), sorted.end(),
        [](const TabulatedRay& a, const TabulatedRay& b) { return a.place < b.place; });
    for (std::size_t begin = 0; begin < sorted.size(); begin += kPacketRays) {
      Packet packet{number, {}, std::min(kPacketRays, sorted.size() - begin)};
      for (std::size_t i = 0; i < kPacketRays; ++i) {
        packet.rays[i] = sorted[begin + std::min(i, packet.count - 1)];
      }
      packets[table].push_back(packet);
    }
  }
  return packets;
}

void append(const Packet& packet, RayBundle& bundle) {
  bundle.group.push_back(packet.orientation);
  for (std::size_t i = 0; i < kPacketRays; ++i) {
    const IntegerLine& line = packet.rays[i].line;
    bundle.slope1.push_back(line.slope[(line.driving_axis + 1) % 3]);
    bundle.slope2.push_back(line.slope[(line.driving_axis + 2) % 3]);
    bundle.reach.push_back(i < packet.count ? line.steps : -1);
  }
}

}  // namespace

FastViewPredictor::FastViewPredictor(const PredictionRaster& raster, double voxel_size_m,
                                     std::vector<Orientation> orientations, bool counts_quality,
                                     int threads)
    : RasterViewPredictor(raster, voxel_size_m, std::move(orientations), counts_quality),
      rays_per_view_(static_cast<std::int64_t>(raster.rays.pixels())),
      packets_of_(this->orientations().size()),
      arena_(std::max(threads, 1)),
      workspaces_(static_cast<std::size_t>(std::max(threads, 1))) {
  if (threads < 1) throw std::invalid_argument("a view predictor needs a thread");
  make_tables(raster, voxel_size_m);
}

void FastViewPredictor::make_tables(const PredictionRaster& raster, double voxel_size_m) {
  std::array<std::vector<Packet>, 6> packets;
  for (std::size_t i = 0; i < orientations().size(); ++i) {
    const auto of_view = packets_of(raster.rays, orientations()[i], static_cast<std::int32_t>(i),
                                    prediction_reach(raster, voxel_size_m));
    for (std::size_t table = 0; table < packets.size(); ++table) {
      packets[table].insert(packets[table].end(), of_view[table].begin(), of_view[table].end());
    }
  }
  tables_.resize(packets.size());
  for (std::size_t i = 0; i < tables_.size(); ++i) {
    std::stable_sort(packets[i].begin(), packets[i].end(),
                     [](const Packet& a, const Packet& b) { return a.place() < b.place(); });
    Table& table = tables_[i];
    table.bundle.driving_axis = static_cast<int>(i / 2);
    table.bundle.direction = i % 2 == 0 ? 1 : -1;
    for (const Packet& packet : packets[i]) {
      append(packet, table.bundle);
      if (!counts_quality()) continue;
      packets_of_[static_cast<std::size_t>(packet.orientation)].push_back(
          {i, table.bundle.packets() - 1});
      for (const TabulatedRay& ray : packet.rays) table.directions.push_back(ray.direction);
    }
    if (counts_quality()) table.occupied_at.resize(table.bundle.rays());
    const std::size_t count = table.bundle.packets();
    const std::size_t length = workspaces_.size() == 1 ? count : kPacketsOfPiece;
    for (std::size_t begin = 0; begin < count; begin += length) {
      pieces_.push_back({i, {begin, std::min(begin + length, count)}});
    }
  }
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

template <class Work>
void FastViewPredictor::share_out(std::size_t count, const Work& work) {
  if (workspaces_.size() == 1) {
    for (std::size_t i = 0; i < count; ++i) work(i, workspaces_.front());
    return;
  }
  arena_.execute([&] {
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      work(i, workspaces_[static_cast<std::size_t>(tbb::this_task_arena::current_thread_index())]);
    });
  });
}

void FastViewPredictor::predict(const VoxelMap& map, const VoxelIndex& sensor,
                                std::span<ViewCounts> per_orientation) {
  check_arguments(map, sensor, per_orientation.size());
  prepare(map);
  for (Workspace& workspace : workspaces_) {
    workspace.counts.assign(per_orientation.size(), RayCounts());
  }
  share_out(pieces_.size(),
            [&](std::size_t i, Workspace& workspace) { cast(pieces_[i], sensor, workspace); });
  for (std::size_t i = 0; i < per_orientation.size(); ++i) {
    ViewCounts& counts = per_orientation[i];
    counts = ViewCounts();
    for (const Workspace& workspace : workspaces_) {
      counts.occupied += workspace.counts[i].occupied;
      counts.occlusion_plane += workspace.counts[i].occlusion_plane;
      counts.unseen += workspace.counts[i].unseen;
    }
    counts.open = rays_per_view_ - counts.occupied - counts.occlusion_plane - counts.unseen;
  }
  if (!counts_quality()) return;
  share_out(per_orientation.size(), [&](std::size_t i, Workspace& workspace) {
    count_improvements(i, workspace, per_orientation[i]);
  });
}

void FastViewPredictor::cast(const Piece& piece, const VoxelIndex& sensor, Workspace& workspace) {
  Table& table = tables_[piece.table];
  RayEnds ends;
  ends.counts = workspace.counts.data();
  if (counts_quality()) ends.occupied_at = table.occupied_at.data();
  cast_bundle(field_->bytes(), field_->shifts(), static_cast<std::int32_t>(field_->offset(sensor)),
              field_->steps_from(sensor), table.bundle, piece.packets, ends);
}

void FastViewPredictor::count_improvements(std::size_t orientation, Workspace& workspace,
                                           ViewCounts& counts) const {
  for (const auto& [number, packet] : packets_of_[orientation]) {
    const std::int32_t* const occupied_at = &tables_[number].occupied_at[packet * kPacketRays];
    const QuantisedDirection* const rays = &tables_[number].directions[packet * kPacketRays];
    for (std::size_t i = 0; i < kPacketRays; ++i) {
      if (occupied_at[i] < 0) continue;
      const std::uint32_t surface = surfaces_.number_at(static_cast<std::size_t>(occupied_at[i]));
      workspace.improvement.add(surface, quantised_cosine(surfaces_[surface].normal, rays[i]));
    }
  }
  workspace.improvement.finish(surfaces_, counts);
}

}  // namespace nextview
