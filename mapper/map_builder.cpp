#include "mapper/map_builder.h"

#include <cmath>
#include <stdexcept>

#include "mapper/image_check.h"
#include "mapper/map_blocks.h"
#include "mapper/map_census.h"
#include "mapper/map_digest.h"
#include "mapper/quality_census.h"
#include "mapper/ray_ends.h"
#include "mapper/ray_marking.h"

namespace nextview {

struct MapBuilder::State {
  State(const VoxelGrid& grid, const MapWindow& window)
      : map(grid, window), blocks(map), census(map, blocks), digest(blocks) {}

  void update_surfaces();
  void leave(const MapWindow& box);
  void derive();

  VoxelMap map;
  MapBlocks blocks;
  MapCensus census;
  QualityCensus quality;
  MapDigest digest;
  RayEnds ray_ends;
  FoldReport report;
};

MapBuilder::MapBuilder(const VoxelGrid& grid, const MapWindow& window)
    : state_(std::make_unique<State>(grid, window)) {}
MapBuilder::~MapBuilder() = default;
MapBuilder::MapBuilder(MapBuilder&&) noexcept = default;
MapBuilder& MapBuilder::operator=(MapBuilder&&) noexcept = default;

const FoldReport& MapBuilder::fold(const RangeImage& image) {
  State& s = *state_;
  check_range_image(image, s.map.grid(), s.map.window());
  s.report.changed_slots.clear();
  s.report.updated_surfaces.clear();

  s.ray_ends.collect(image, s.map.grid(), s.map.window());  // eq. 1, eq. 2, normals (P9)
  const VoxelIndex sensor = s.map.grid().voxel_of(image.position_m);
  s.report.newly_occupied = mark_rays(s.map, sensor, s.ray_ends.ends(), s.ray_ends.shadows(),
                                      s.report.changed_slots);  // P12
  s.update_surfaces();                                          // P9
  s.census.note_changes(s.blocks, s.report.changed_slots);
  s.derive();

  const PixelCounts& pixels = s.ray_ends.counts();
  s.report.points = pixels.points;
  s.report.points_outside = pixels.points_outside;
  s.report.no_returns = pixels.no_returns;
  s.report.invalid = pixels.invalid;
  return s.report;
}

void MapBuilder::State::update_surfaces() {
  for (const RayEnd& end : ray_ends.ends()) {
    if (!end.is_surface) continue;
    if (end.seen.normal_count > 0 || map.surface(end.voxel) == nullptr) {
      report.updated_surfaces.push_back(static_cast<std::uint32_t>(map.slot(end.voxel)));
    }
    SurfaceVoxel& voxel = map.surface_at(end.voxel);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      voxel.normal_sum[axis] += end.seen.normal_sum[axis];
    }
    voxel.normal_count += end.seen.normal_count;
    if (end.seen.quality > voxel.quality) {
      quality.change(voxel.quality, end.seen.quality);
      voxel.quality = end.seen.quality;
    }
    digest.invalidate(blocks.block_of(map.slot(end.voxel)));
  }
}

std::span<const std::uint32_t> MapBuilder::move_window(const VoxelIndex& new_min) {
  State& s = *state_;
  s.report.changed_slots.clear();
  for (const MapWindow& box : left_behind(s.map.window(), new_min)) s.leave(box);
  s.map.move_window(new_min);
  s.blocks.move_window(new_min);
  s.derive();
  return s.report.changed_slots;
}

void MapBuilder::State::leave(const MapWindow& box) {
  for_each_voxel(box, [this](const VoxelIndex& voxel) {
    const SurfaceVoxel* const surface = map.surface(voxel);
    if (surface != nullptr) quality.forget(surface->quality);
  });
  blocks.for_each_in(box, [this](std::uint32_t block) { census.note_leaving(blocks, block); });
}

// Occlusion planes, areas (P13) and what the digest must hash again.
void MapBuilder::State::derive() {
  const auto changed_blocks = census.update(map, blocks, report.changed_slots);
  for (const std::uint32_t block : changed_blocks) digest.invalidate(block);
}

const VoxelMap& MapBuilder::map() const { return state_->map; }

MapStatistics MapBuilder::statistics() const {
  const State& s = *state_;
  return map_statistics(s.census.totals(), s.quality, s.map.grid().voxel_size_m);
}

std::string MapBuilder::digest() { return state_->digest.digest(state_->map, state_->blocks); }

std::size_t MapBuilder::memory_bytes() const {
  const State& s = *state_;
  return sizeof(State) + s.map.memory_bytes() + s.census.memory_bytes() + s.quality.memory_bytes() +
         s.digest.memory_bytes() + s.ray_ends.memory_bytes() +
         (s.report.changed_slots.capacity() + s.report.updated_surfaces.capacity()) *
             sizeof(std::uint32_t);
}

}  // namespace nextview
