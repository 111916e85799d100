#include "planner/prediction/surface_gain.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "planner/prediction/grown_surface.h"

namespace nextview {

namespace {

bool is_unknown(std::uint8_t byte) {
  return byte == FreeSpaceField::kUnseen || byte == FreeSpaceField::kOcclusionPlane;
}

}  // namespace

SurfaceGain::SurfaceGain(const PredictionRaster& raster, double voxel_size_m,
                         std::vector<Orientation> orientations, const Parameters& parameters)
    : parameters_(parameters),
      orientations_(std::move(orientations)),
      panorama_(prediction_reach(raster, voxel_size_m)),
      views_(raster.rays, orientations_) {
  if (orientations_.empty()) throw std::invalid_argument("there are no orientations to judge");
  met_at_.assign(Panorama::kCells, -1);
  grown_at_.assign(Panorama::kCells, -1);
  improvement_.resize(Panorama::kCells);
  for (int cell = 0; cell < Panorama::kCells; ++cell) {
    directions_.push_back(quantise_direction(Panorama::direction(cell)));
  }
}

void SurfaceGain::look_from(const Known& known, const VoxelIndex& sensor) {
  noted_.resize(known.field.size(), 0);
  for (const std::uint32_t block : blocks_) noted_[block] = 0;
  blocks_.clear();
  panorama_.cast(known.field, sensor, met_at_);
  count(met_at_, known.field.size(), met_);
  if (parameters_.improvement_weight > 0.0) add_improvement(known);
  weigh_unknown(known);
  if (known.grown != nullptr) {
    panorama_.cast(known.grown->field(), sensor, grown_at_);
    count(grown_at_, known.field.size(), grown_);
    weigh_grown(known);
  } else {
    grown_.by_offset.resize(1, 0);
  }
  sum_cells();
  forget(met_);
  forget(grown_);
}

void SurfaceGain::count(const Cells& met_at, std::size_t offsets, Tally& tally) {
  tally.by_offset.resize(offsets, 0);
  for (const std::int32_t at : met_at) {
    if (at < 0) continue;
    if (tally.by_offset[static_cast<std::size_t>(at)]++ == 0) {
      tally.offsets.push_back(static_cast<std::uint32_t>(at));
    }
  }
}

void SurfaceGain::forget(Tally& tally) {
  for (const std::uint32_t offset : tally.offsets) tally.by_offset[offset] = 0;
  tally.offsets.clear();
}

void SurfaceGain::weigh_unknown(const Known& known) {
  const auto whole = static_cast<std::int32_t>(parameters_.unknown_weight * kUnit);
  for (const std::uint32_t offset : met_.offsets) {
    std::int32_t& value = met_.by_offset[offset];
    if (!is_unknown(known.field.bytes()[offset])) {
      value = kOccupied;
      continue;
    }
    value = (whole >> std::min<int>(known.in_vain[offset], 30)) / value;
    note_block(known, offset);
  }
}

void SurfaceGain::weigh_grown(const Known& known) {
  for (const std::uint32_t offset : grown_.offsets) {
    const std::int32_t likely = known.grown->likelihood(offset);
    std::int32_t& value = grown_.by_offset[offset];
    value = (likely >> std::min<int>(known.in_vain[offset], 30)) / value;
    if (likely > 0) note_block(known, offset);
  }
}

void SurfaceGain::add_improvement(const Known& known) {
  for (std::size_t cell = 0; cell < met_at_.size(); ++cell) {
    improvement_[cell] = 0;
    if (met_at_[cell] < 0) continue;
    const auto offset = static_cast<std::uint32_t>(met_at_[cell]);
    if (is_unknown(known.field.bytes()[offset])) continue;
    const SurfaceTable::Surface& surface = (*known.surfaces)[known.surfaces->number_at(offset)];
    const int better =
        predicted_quality(quantised_cosine(surface.normal, directions_[cell])) - surface.quality;
    if (better <= 0) continue;
    improvement_[cell] = better / met_.by_offset[offset];
    note_block(known, offset);
  }
  PanoramaViews::sum_rows(improvement_, improvement_sums_);
}

void SurfaceGain::note_block(const Known& known, std::uint32_t offset) {
  const std::uint32_t block = field_block(known.field.shifts(), offset);
  if (noted_[block] != 0) return;
  noted_[block] = 1;
  blocks_.push_back(block);
}

void SurfaceGain::sum_cells() {
  // Offset 0 lies outside the window: nothing is ever met there, and it counts 0.
  const auto value_at = [](const Tally& tally, std::int32_t at) {
    return tally.by_offset[static_cast<std::size_t>(std::max(at, 0))];
  };
  std::size_t sum = 0;
  for (std::size_t cell = 0; cell < met_at_.size(); ++cell) {
    if (cell % Panorama::kSide == 0) {
      gain_sums_[sum] = occupied_sums_[sum] = 0;
      ++sum;
    }
    const std::int32_t met = value_at(met_, met_at_[cell]);
    const std::int32_t grown = value_at(grown_, grown_at_[cell]);
    gain_sums_[sum] = gain_sums_[sum - 1] + std::max(met, 0) + grown;
    occupied_sums_[sum] = occupied_sums_[sum - 1] + (met == kOccupied ? 1 : 0);
    ++sum;
  }
}

ExpectedView SurfaceGain::view(std::size_t orientation) const {
  ExpectedView view;
  view.orientation = orientation;
  view.new_voxels = static_cast<double>(views_.sum(gain_sums_, orientation)) / kUnit;
  if (parameters_.improvement_weight > 0.0) {
    view.improvement = static_cast<double>(views_.sum(improvement_sums_, orientation)) / kUnit;
  }
  view.overlap = static_cast<double>(views_.sum(occupied_sums_, orientation)) /
                 std::max(1, views_.cells(orientation));
  return view;
}

ExpectedView SurfaceGain::best() const {
  ExpectedView best;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    const ExpectedView candidate = view(i);
    if (candidate.overlap < parameters_.min_overlap) continue;
    if (candidate.value(parameters_.improvement_weight) >
        best.value(parameters_.improvement_weight)) {
      best = candidate;
    }
  }
  return best;
}

std::vector<std::uint32_t> SurfaceGain::aimed_at(const Known& known,
                                                 std::size_t orientation) const {
  std::vector<std::uint32_t> offsets;
  views_.for_each_cell(orientation, [&](int cell) {
    const std::int32_t at = met_at_[static_cast<std::size_t>(cell)];
    if (at >= 0 && is_unknown(known.field.bytes()[at])) {
      offsets.push_back(static_cast<std::uint32_t>(at));
    }
    const std::int32_t grown = grown_at_[static_cast<std::size_t>(cell)];
    if (known.grown != nullptr && grown >= 0 &&
        known.grown->likelihood(static_cast<std::size_t>(grown)) > 0) {
      offsets.push_back(static_cast<std::uint32_t>(grown));
    }
  });
  std::ranges::sort(offsets);
  offsets.erase(std::unique(offsets.begin(), offsets.end()), offsets.end());
  return offsets;
}

ViewCounts SurfaceGain::counts(const Known& known, std::size_t orientation) const {
  ViewCounts counts;
  views_.for_each_cell(orientation, [&](int cell) {
    const std::int32_t at = met_at_[static_cast<std::size_t>(cell)];
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
