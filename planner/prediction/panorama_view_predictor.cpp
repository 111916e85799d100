#include "planner/prediction/panorama_view_predictor.h"

#include <omp.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "lcmtypes/parameter_bounds.h"
#include "sensor/elementary_functions.h"
#include "sensor/sensor_pose.h"

namespace nextview {

namespace {

constexpr int kFaceSide = PanoramaViewPredictor::kFaceSide;
constexpr double kQuarter = std::numbers::pi / 4.0;

// A cell of the panorama: a face of the cube (2 axis + (sign < 0)) and a row and column on it.
struct Cell {
  int face;
  int row;
  int column;
};

// Cells are numbered in tiles of 8 x 8, a word each, and in quarters of 4 x 4 inside, so that a
// word's cells, and a vector's rays, are neighbours.
int cell_number(const Cell& cell) {
  const int tile = (cell.face * (kFaceSide / 8) + cell.row / 8) * (kFaceSide / 8) + cell.column / 8;
  const int quarter = cell.row % 8 / 4 * 2 + cell.column % 8 / 4;
  return tile * 64 + quarter * 16 + cell.row % 4 * 4 + cell.column % 4;
}

/// Slopes across a face: at a cell's middle, and where it begins and ends.
struct CellSlopes {
  std::array<double, kFaceSide> middle;
  std::array<double, kFaceSide + 1> edge;
};

const CellSlopes& cell_slopes() {
  static const CellSlopes slopes = [] {
    const auto slope = [](double cells) {
      return elementary::tan(kQuarter * (2.0 * cells / kFaceSide - 1.0));
    };
    CellSlopes result{};
    for (std::size_t i = 0; i <= kFaceSide; ++i) {
      result.edge[i] = slope(static_cast<double>(i));
      if (i < kFaceSide) result.middle[i] = slope(static_cast<double>(i) + 0.5);
    }
    return result;
  }();
  return slopes;
}

// The cell a slope lies in.
int place_of(double slope) {
  const auto& edges = cell_slopes().edge;
  // The C library's angle, whose last bits are the processor's, says about where that is.
  const double about = (std::atan(slope) / kQuarter + 1.0) * kFaceSide / 2.0;
  auto place = static_cast<std::size_t>(std::clamp(static_cast<int>(about), 0, kFaceSide - 1));
  while (place + 1 < kFaceSide && slope >= edges[place + 1]) ++place;
  while (place > 0 && slope < edges[place]) --place;
  return static_cast<int>(place);
}

Eigen::Vector3d cell_direction(const Cell& cell) {
  const auto slope = [](int i) { return cell_slopes().middle[static_cast<std::size_t>(i)]; };
  const int axis = cell.face / 2;
  Eigen::Vector3d direction;
  direction[axis] = cell.face % 2 == 0 ? 1.0 : -1.0;
  direction[(axis + 1) % 3] = slope(cell.column);
  direction[(axis + 2) % 3] = slope(cell.row);
  return direction.normalized();
}

// The other way round than cell_number.
Cell cell_numbered(int number) {
  const int tile = number / 64;
  const int quarter = number % 64 / 16;
  const int row = tile / (kFaceSide / 8) % (kFaceSide / 8) * 8 + quarter / 2 * 4 + number % 16 / 4;
  const int column = tile % (kFaceSide / 8) * 8 + quarter % 2 * 4 + number % 4;
  return {number / (kFaceSide * kFaceSide), row, column};
}

Cell cell_of(const Eigen::Vector3d& direction) {
  int axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  const double depth = std::abs(direction[axis]);
  return {2 * axis + (direction[axis] < 0.0), place_of(direction[(axis + 2) % 3] / depth),
          place_of(direction[(axis + 1) % 3] / depth)};
}

std::vector<RayBundle> cube_faces(double reach) {
  std::vector<RayBundle> faces(6);
  for (int face = 0; face < 6; ++face) {
    RayBundle& bundle = faces[static_cast<std::size_t>(face)];
    bundle.driving_axis = face / 2;
    bundle.direction = face % 2 == 0 ? 1 : -1;
    constexpr auto kRays = static_cast<std::size_t>(kFaceSide * kFaceSide);
    bundle.packets.resize(kRays / RayBundle::kPacketRays);
    bundle.group.resize(kRays / RayBundle::kPacketRays);
    for (int row = 0; row < kFaceSide; ++row) {
      for (int column = 0; column < kFaceSide; ++column) {
        const Cell cell{face, row, column};
        const auto ray = static_cast<std::size_t>(cell_number(cell) - face * kFaceSide * kFaceSide);
        const IntegerLine line = line_along(VoxelIndex::Zero(), cell_direction(cell), reach);
        // Rounding can make a cell at the very rim a tie between two driving axes, but no other
        // axis ever advances more than the face's.
        RayBundle::Packet& packet = bundle.packets[ray / RayBundle::kPacketRays];
        const std::size_t place = ray % RayBundle::kPacketRays;
        packet.slope1[place] = line.slope[(bundle.driving_axis + 1) % 3];
        packet.slope2[place] = line.slope[(bundle.driving_axis + 2) % 3];
        packet.reach[place] = line.steps;
      }
    }
  }
  return faces;
}

}  // namespace

PanoramaViewPredictor::PanoramaViewPredictor(const PredictionRaster& raster, double voxel_size_m,
                                             std::vector<Orientation> orientations,
                                             bool counts_surfaces, int threads)
    : RasterViewPredictor(raster, voxel_size_m, std::move(orientations), counts_surfaces),
      rays_per_view_(static_cast<std::int64_t>(raster.rays.pixels())),
      surface_counts_(static_cast<std::size_t>(std::max(threads, 1))) {
  bounds::kThreads.require(threads);
  faces_ = cube_faces(prediction_reach(raster, voxel_size_m));
  for (const Orientation& orientation : this->orientations()) {
    all_views_.push_back(views_.size());
    append_view(raster.rays, orientation);
  }
  if (!counts_surfaces) return;
  panorama_.occupied_at.resize(kCells);
  panorama_.sightings.resize(kCells);
  for (int cell = 0; cell < kCells; ++cell) {
    directions_.push_back(quantise_direction(cell_direction(cell_numbered(cell))));
  }
}

std::vector<Eigen::Vector3d> PanoramaViewPredictor::rays() const {
  std::vector<Eigen::Vector3d> rays;
  for (const View& view : views_) {
    for (std::uint32_t i = view.begin; i < view.end; ++i) {
      for (std::uint64_t cells = weights_[i].cells; cells != 0; cells &= cells - 1) {
        const int cell = static_cast<int>(weights_[i].word) * 64 + std::countr_zero(cells);
        rays.insert(rays.end(), std::size_t{1} << weights_[i].plane,
                    cell_direction(cell_numbered(cell)));
      }
    }
  }
  return rays;
}

void PanoramaViewPredictor::append_view(const RayTable& rays, const Orientation& orientation) {
  const Eigen::Matrix3d rotation =
      world_from_sensor_rotation(orientation.pan_rad, orientation.tilt_rad);
  std::vector<std::uint32_t> weight(kCells, 0);
  for (int v = 0; v < rays.rows(); ++v) {
    for (int u = 0; u < rays.columns(); ++u) {
      ++weight[static_cast<std::size_t>(cell_number(cell_of(rotation * rays.ray(u, v))))];
    }
  }
  const auto begin = static_cast<std::uint32_t>(weights_.size());
  for (std::uint32_t word = 0; word < kWords; ++word) {
    const std::uint32_t* cells = &weight[std::size_t{word} * 64];
    const std::uint32_t largest = *std::max_element(cells, cells + 64);
    for (std::uint32_t plane = 0; largest >> plane != 0; ++plane) {
      WeightWord bits{word, plane, 0};
      for (int i = 0; i < 64; ++i) {
        bits.cells |= static_cast<std::uint64_t>(cells[i] >> plane & 1) << i;
      }
      if (bits.cells != 0) weights_.push_back(bits);
    }
  }
  views_.push_back({begin, static_cast<std::uint32_t>(weights_.size())});
}

// Compiled once more for x86-64 processors that count bits in one instruction; others all do.
#if defined(__x86_64__)
[[gnu::target_clones("popcnt", "default")]]
#endif
ViewCounts
PanoramaViewPredictor::count_cells(const Panorama& panorama, bool any_open, const WeightWord* begin,
                                   const WeightWord* end) {
  const auto population = [](const std::vector<std::uint64_t>& bits, const WeightWord& weight) {
    return static_cast<std::int64_t>(std::popcount(bits[weight.word] & weight.cells))
           << weight.plane;
  };
  ViewCounts counts;
  for (const WeightWord* weight = begin; weight != end; ++weight) {
    counts.occupied += population(panorama.occupied, *weight);
    counts.occlusion_plane += population(panorama.occlusion_plane, *weight);
  }
  if (!any_open) return counts;
  for (const WeightWord* weight = begin; weight != end; ++weight) {
    counts.unseen += population(panorama.unseen, *weight);
  }
  return counts;
}

bool PanoramaViewPredictor::any_is_open() const {
  for (std::size_t i = 0; i < kWords; ++i) {
    if (~(panorama_.occupied[i] | panorama_.occlusion_plane[i] | panorama_.unseen[i]) != 0) {
      return true;
    }
  }
  return false;
}

void PanoramaViewPredictor::predict(const KnownSpace& space, const VoxelIndex& sensor,
                                    std::span<ViewCounts> per_orientation) {
  check_arguments(space.map(), sensor, per_orientation.size());
  look_from(space, sensor);
  count(all_views_, per_orientation);
}

void PanoramaViewPredictor::look_from(const KnownSpace& space, const VoxelIndex& sensor) {
  check_arguments(space.map(), sensor, orientations().size());
  for (auto* bits : {&panorama_.occupied, &panorama_.occlusion_plane, &panorama_.unseen}) {
    bits->assign(kWords, 0);
  }
  surfaces_ = counts_surfaces() ? &space.surfaces() : nullptr;
#pragma omp parallel for schedule(dynamic) num_threads(threads()) if (threads() > 1)
  for (std::size_t face = 0; face < faces_.size(); ++face) {
    cast_face(space.field(), face, sensor);
    if (surfaces_ != nullptr) look_up(*surfaces_, face);
  }
  any_open_ = any_is_open();
}

void PanoramaViewPredictor::count(std::span<const std::size_t> which,
                                  std::span<ViewCounts> counts) {
  check_asked(which.size(), counts.size());
#pragma omp parallel for schedule(dynamic, 16) \
    num_threads(threads()) if (threads() > 1 && which.size() > 16)
  for (std::size_t i = 0; i < which.size(); ++i) {
    const View& view = views_[which[i]];
    ViewCounts& of_view = counts[i];
    of_view = count_cells(panorama_, any_open_, &weights_[view.begin], weights_.data() + view.end);
    std::int64_t& rest = any_open_ ? of_view.open : of_view.unseen;
    rest = rays_per_view_ - of_view.occupied - of_view.occlusion_plane - of_view.unseen;
    if (surfaces_ == nullptr) continue;
    const auto thread = static_cast<std::size_t>(omp_get_thread_num());
    count_surfaces(*surfaces_, view, surface_counts_[thread], of_view);
  }
}

void PanoramaViewPredictor::cast_face(const FreeSpaceField& field, std::size_t face,
                                      const VoxelIndex& sensor) {
  const std::size_t word = face * kFaceSide * kFaceSide / 64;
  PacketQueue packets;
  packets.refill(faces_[face].packets.size(), faces_[face].packets.size());
  RayOutcomes outcomes;
  outcomes.occupied = reinterpret_cast<std::uint8_t*>(&panorama_.occupied[word]);
  outcomes.occlusion_plane = reinterpret_cast<std::uint8_t*>(&panorama_.occlusion_plane[word]);
  outcomes.unseen = reinterpret_cast<std::uint8_t*>(&panorama_.unseen[word]);
  if (counts_surfaces()) outcomes.occupied_at = &panorama_.occupied_at[word * 64];
  cast_bundle(field.bytes(), field.shifts(), static_cast<std::int32_t>(field.offset(sensor)),
              field.steps_from(sensor), faces_[face], packets, outcomes);
}

void PanoramaViewPredictor::look_up(const SurfaceTable& surfaces, std::size_t face) {
  const std::size_t first = face * kFaceSide * kFaceSide;
  for (std::size_t cell = first; cell < first + kFaceSide * kFaceSide; ++cell) {
    if (panorama_.occupied_at[cell] < 0) continue;
    const auto offset = static_cast<std::size_t>(panorama_.occupied_at[cell]);
    const std::uint32_t surface = surfaces.number_at(offset);
    panorama_.sightings[cell] = {surface,
                                 quantised_cosine(surfaces[surface].normal, directions_[cell])};
  }
}

void PanoramaViewPredictor::count_surfaces(const SurfaceTable& surfaces, const View& view,
                                           SurfaceCount& count, ViewCounts& counts) const {
  for (std::uint32_t i = view.begin; i < view.end;) {
    const std::uint32_t word = weights_[i].word;
    std::uint64_t cells = 0;
    for (; i < view.end && weights_[i].word == word; ++i) cells |= weights_[i].cells;
    for (cells &= panorama_.occupied[word]; cells != 0; cells &= cells - 1) {
      const std::size_t cell =
          std::size_t{word} * 64 + static_cast<std::size_t>(std::countr_zero(cells));
      count.add(panorama_.sightings[cell].surface, panorama_.sightings[cell].cosine);
    }
  }
  count.finish(surfaces, counts);
}

}  // namespace nextview
