#include "planner/prediction/surface_gain.h"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <utility>

#include "planner/prediction/grown_surface.h"

namespace nextview {

namespace {

bool is_unknown(std::uint8_t byte) {
  return byte == FreeSpaceField::kUnseen || byte == FreeSpaceField::kOcclusionPlane;
}

template <class Visit>
void for_each(std::uint64_t cells, std::size_t row, Visit visit) {
  for (; cells != 0; cells &= cells - 1) {
    visit(row * Panorama::kSide + static_cast<std::size_t>(std::countr_zero(cells)));
  }
}

template <class Visit>
void for_each(const Panorama::Cells& cells, Visit visit) {
  for (std::size_t row = 0; row < cells.size(); ++row) for_each(cells[row], row, visit);
}

// Of one row of cells.
using RowValues = std::array<std::int32_t, Panorama::kSide>;

}  // namespace

SurfaceGain::SurfaceGain(const PredictionRaster& raster, double voxel_size_m,
                         std::vector<Orientation> orientations, const Parameters& parameters)
    : parameters_(parameters),
      orientations_(std::move(orientations)),
      panorama_(prediction_reach(raster, voxel_size_m)),
      views_(raster.rays, orientations_) {
  if (orientations_.empty()) throw std::invalid_argument("there are no orientations to judge");
  grown_at_.assign(Panorama::kCells, -1);
  for (int cell = 0; cell < Panorama::kCells; ++cell) {
    directions_.push_back(quantise_direction(Panorama::direction(cell)));
  }
}

void SurfaceGain::look_from(const Known& known, const VoxelIndex& sensor) {
  look(known, sensor, Panorama::all_packets());
  judge(known);
}

void SurfaceGain::look_again(const Known& known, const VoxelIndex& sensor,
                             Panorama::Packets& finished) {
  if (parameters_.improvement_weight > 0.0) {
    look_from(known, sensor);
    return;
  }
  Panorama::Packets to_cast{};
  if (known.grown != nullptr) {
    for (const VoxelIndex& bridge : known.grown->bridges()) {
      Panorama::add_passing(bridge - sensor, to_cast);
    }
  }
  for (std::size_t i = 0; i < to_cast.size(); ++i) to_cast[i] |= ~finished[i];
  look(known, sensor, to_cast);
  Panorama::Cells known_cells = met_.occupied;
  for (std::size_t row = 0; row < known_cells.size(); ++row) known_cells[row] &= ~met_.plane[row];
  for (std::size_t i = 0; i < finished.size(); ++i) finished[i] &= ~to_cast[i];
  Panorama::add_all(finished, known_cells);
  Panorama::add_all(finished, met_.occupied);
  finished = Panorama::with_all(known_cells);
  judge(known);
}

void SurfaceGain::judge(const Known& known) {
  if (noted_.size() < known.field.size()) {
    noted_ = LazyArray<std::uint8_t>(known.field.size());
    blocks_.clear();
  }
  for (const std::uint32_t block : blocks_) noted_[block] = 0;
  blocks_.clear();
  if (parameters_.improvement_weight > 0.0) add_improvement(known);
  weigh_unknown(known);
  weigh_grown(known);
  sum_cells();
  forget(unknown_);
  forget(grown_);
}

// What a cell meets first and the grown voxel it meets when nothing else unknown stops it are
// mostly the same voxel, or known. So cells are cast once, until anything that can be new, and then
// only those again that have met but one of the two.
void SurfaceGain::look(const Known& known, const VoxelIndex& sensor,
                       const Panorama::Packets& to_cast) {
  if (known.grown == nullptr) {
    panorama_.cast(known.field, sensor, to_cast, met_);
    grown_cells_ = {};
    for (std::size_t row = 0; row < unknown_cells_.size(); ++row) {
      unknown_cells_[row] = met_.unseen[row] | met_.plane[row];
    }
    return;
  }
  panorama_.cast(known.grown->unknown_too(), sensor, to_cast, met_);
  panorama_.cast(known.grown->field(), sensor, Panorama::with_any(met_.unseen), behind_);
  for (std::size_t row = 0; row < grown_cells_.size(); ++row) {
    const std::uint64_t behind = met_.unseen[row] & behind_.plane[row];
    for_each(behind, row, [&](std::size_t cell) { grown_at_[cell] = behind_.at[cell]; });
    for_each(met_.plane[row], row, [&](std::size_t cell) { grown_at_[cell] = met_.at[cell]; });
    grown_cells_[row] = met_.plane[row] | behind;
  }
  look_behind_bridges(known, sensor);
}

// A plane may bridge Empty voxels: what is unknown is met behind them.
void SurfaceGain::look_behind_bridges(const Known& known, const VoxelIndex& sensor) {
  Panorama::Cells bridges{};
  bool any = false;
  for_each(met_.plane, [&](std::size_t cell) {
    if (is_unknown(known.field.bytes()[met_.at[cell]])) return;
    bridges[cell / Panorama::kSide] |= std::uint64_t{1} << cell % Panorama::kSide;
    any = true;
  });
  if (any) {
    panorama_.cast(known.field, sensor, Panorama::with_any(bridges), behind_);
    for_each(bridges, [&](std::size_t cell) { met_.at[cell] = behind_.at[cell]; });
  }
  for (std::size_t row = 0; row < unknown_cells_.size(); ++row) {
    unknown_cells_[row] = met_.unseen[row] | (met_.plane[row] & ~bridges[row]);
    if (bridges[row] == 0) continue;
    unknown_cells_[row] |= bridges[row] & (behind_.unseen[row] | behind_.plane[row]);
    met_.occupied[row] |= bridges[row] & behind_.occupied[row];
  }
}

void SurfaceGain::count(const Panorama::Cells& cells, const std::vector<std::int32_t>& met_at,
                        std::size_t offsets, Tally& tally) {
  if (tally.by_offset.size() < offsets) tally.by_offset = LazyArray<std::int32_t>(offsets);
  for_each(cells, [&](std::size_t cell) {
    const auto offset = static_cast<std::uint32_t>(met_at[cell]);
    if (tally.by_offset[offset]++ == 0) tally.offsets.push_back(offset);
  });
}

void SurfaceGain::forget(Tally& tally) {
  for (const std::uint32_t offset : tally.offsets) tally.by_offset[offset] = 0;
  tally.offsets.clear();
}

void SurfaceGain::weigh_unknown(const Known& known) {
  count(unknown_cells_, met_.at, known.field.size(), unknown_);
  const auto whole = static_cast<std::int32_t>(parameters_.unknown_weight * kUnit);
  for (const std::uint32_t offset : unknown_.offsets) {
    std::int32_t& value = unknown_.by_offset[offset];
    value = (whole >> std::min<int>(known.in_vain[offset], 30)) / value;
    note_block(known, offset);
  }
}

void SurfaceGain::weigh_grown(const Known& known) {
  if (known.grown == nullptr) return;  // no cell meets what is grown
  count(grown_cells_, grown_at_, known.field.size(), grown_);
  for (const std::uint32_t offset : grown_.offsets) {
    std::int32_t& value = grown_.by_offset[offset];
    value = (known.grown->likelihood(offset) >> std::min<int>(known.in_vain[offset], 30)) / value;
    note_block(known, offset);
  }
}

void SurfaceGain::add_improvement(const Known& known) {
  count(met_.occupied, met_.at, known.field.size(), unknown_);
  for (std::size_t row = 0; row < met_.occupied.size(); ++row) {
    RowValues values{};
    for_each(met_.occupied[row], row, [&](std::size_t cell) {
      const auto offset = static_cast<std::uint32_t>(met_.at[cell]);
      const SurfaceTable::Surface& surface = (*known.surfaces)[known.surfaces->number_at(offset)];
      const int better =
          predicted_quality(quantised_cosine(surface.normal, directions_[cell])) - surface.quality;
      if (better <= 0) return;
      values[cell % Panorama::kSide] = better / unknown_.by_offset[offset];
      note_block(known, offset);
    });
    PanoramaViews::sum_row(values, row, improvement_sums_);
  }
  forget(unknown_);
}

void SurfaceGain::sum_cells() {
  for (std::size_t row = 0; row < unknown_cells_.size(); ++row) {
    if ((unknown_cells_[row] | grown_cells_[row]) == 0) {
      PanoramaViews::sum_no_cells(row, gain_sums_);
      continue;
    }
    RowValues values{};
    const auto add = [&](std::uint64_t cells, const std::vector<std::int32_t>& at,
                         const Tally& tally) {
      for_each(cells, row, [&](std::size_t cell) {
        values[cell % Panorama::kSide] += tally.by_offset[static_cast<std::size_t>(at[cell])];
      });
    };
    add(unknown_cells_[row], met_.at, unknown_);
    add(grown_cells_[row], grown_at_, grown_);
    PanoramaViews::sum_row(values, row, gain_sums_);
  }
}

void SurfaceGain::note_block(const Known& known, std::uint32_t offset) {
  const std::uint32_t block = field_block(known.field.shifts(), offset);
  if (noted_[block] != 0) return;
  noted_[block] = 1;
  blocks_.push_back(block);
}

double SurfaceGain::overlap(std::size_t orientation) const {
  return static_cast<double>(views_.count(met_.occupied, orientation)) /
         std::max(1, views_.cells(orientation));
}

ExpectedView SurfaceGain::new_in(std::size_t orientation) const {
  ExpectedView view;
  view.orientation = orientation;
  view.new_voxels = static_cast<double>(views_.sum(gain_sums_, orientation)) / kUnit;
  if (parameters_.improvement_weight > 0.0) {
    view.improvement = static_cast<double>(views_.sum(improvement_sums_, orientation)) / kUnit;
  }
  return view;
}

ExpectedView SurfaceGain::view(std::size_t orientation) const {
  ExpectedView view = new_in(orientation);
  view.overlap = overlap(orientation);
  return view;
}

ExpectedView SurfaceGain::best() const {
  ExpectedView best;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    ExpectedView candidate = new_in(i);
    if (candidate.value(parameters_.improvement_weight) <=
        best.value(parameters_.improvement_weight)) {
      continue;
    }
    candidate.overlap = overlap(i);
    if (candidate.overlap >= parameters_.min_overlap) best = candidate;
  }
  return best;
}

std::vector<std::uint32_t> SurfaceGain::aimed_at(std::size_t orientation) const {
  std::vector<std::uint32_t> offsets;
  views_.for_each_cell(orientation, [&](int cell) {
    const auto at = static_cast<std::size_t>(cell);
    const auto is_in = [&](const Panorama::Cells& cells) {
      return (cells[at / Panorama::kSide] >> at % Panorama::kSide & 1) != 0;
    };
    if (is_in(unknown_cells_)) offsets.push_back(static_cast<std::uint32_t>(met_.at[at]));
    if (is_in(grown_cells_)) offsets.push_back(static_cast<std::uint32_t>(grown_at_[at]));
  });
  std::ranges::sort(offsets);
  offsets.erase(std::unique(offsets.begin(), offsets.end()), offsets.end());
  return offsets;
}

ViewCounts SurfaceGain::counts(const Known& known, std::size_t orientation) const {
  ViewCounts counts;
  views_.for_each_cell(orientation, [&](int cell) {
    const std::int32_t at = met_.at[static_cast<std::size_t>(cell)];
    if (at < 0) {
      ++counts.open;
      return;
    }
    const std::uint8_t byte = known.field.bytes()[at];
    counts.occupied += byte == FreeSpaceField::kOccupied ? 1 : 0;
    counts.occlusion_plane += byte == FreeSpaceField::kOcclusionPlane ? 1 : 0;
    counts.unseen += byte == FreeSpaceField::kUnseen ? 1 : 0;
  });
  return counts;
}

}  // namespace nextview
