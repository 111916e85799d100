#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "mapper/integer_line.h"
#include "planner/prediction/grown_surface.h"
#include "planner/prediction/surface_gain.h"

namespace nextview {

/// A view judged by the definition of SurfaceGain, one ray and one voxel after the other.
class PlainGain {
 public:
  PlainGain(const VoxelMap& map, const FreeSpaceField& field, std::span<const std::uint8_t> in_vain,
            const GrownSurface& grown, const VoxelIndex& sensor, double reach_voxels,
            double unknown_weight)
      : map_(map),
        field_(field),
        in_vain_(in_vain),
        grown_(grown),
        reach_voxels_(reach_voxels),
        weight_(unknown_weight) {
    for (int cell = 0; cell < Panorama::kCells; ++cell) {
      unknown_.push_back(first(
          cell, sensor, [&](const VoxelIndex& at) { return map_.label(at) != Label::Empty; }));
      surface_.push_back(first(cell, sensor, [&](const VoxelIndex& at) {
        return map_.label(at) == Label::Occupied || grown_.likelihood(field_.offset(at)) > 0;
      }));
      ++cells_of_[unknown_.back()];
      ++grown_cells_of_[surface_.back()];
    }
  }

  ExpectedView view(const std::vector<int>& cells) const {
    ExpectedView view;
    for (const int cell : cells) {
      const std::size_t seen = unknown_[static_cast<std::size_t>(cell)];
      const std::size_t grown = surface_[static_cast<std::size_t>(cell)];
      if (seen != kNone && map_.label(field_.index_of(seen)) == Label::Occupied) {
        view.overlap += 1.0 / static_cast<double>(cells.size());
      } else if (seen != kNone) {
        view.new_voxels += weight_ * std::pow(0.5, in_vain_[seen]) / cells_of_.at(seen);
      }
      if (grown != kNone) {
        const double likely =
            static_cast<double>(grown_.likelihood(grown)) / GrownSurface::kCertain;
        view.new_voxels += likely * std::pow(0.5, in_vain_[grown]) / grown_cells_of_.at(grown);
      }
    }
    return view;
  }

  /// What the cells meet, as if each were a ray.
  ViewCounts counts(const std::vector<int>& cells) const {
    ViewCounts counts;
    for (const int cell : cells) {
      const std::size_t met = unknown_[static_cast<std::size_t>(cell)];
      if (met == kNone) {
        ++counts.open;
        continue;
      }
      const Label label = map_.label(field_.index_of(met));
      counts.occupied += label == Label::Occupied;
      counts.occlusion_plane += label == Label::OcclusionPlane;
      counts.unseen += label == Label::Unmarked || label == Label::Occluded;
    }
    return counts;
  }

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};

  template <class Stops>
  std::size_t first(int cell, const VoxelIndex& sensor, Stops stops) const {
    const IntegerLine line = line_along(sensor, Panorama::direction(cell), reach_voxels_);
    for (int k = 1; k <= std::min(line.steps, steps_inside(line, map_.window())); ++k) {
      if (stops(line.at(k))) return field_.offset(line.at(k));
    }
    return kNone;
  }

  const VoxelMap& map_;
  const FreeSpaceField& field_;
  std::span<const std::uint8_t> in_vain_;
  const GrownSurface& grown_;
  double reach_voxels_;
  double weight_;
  std::vector<std::size_t> unknown_;  // by cell: the offset met
  std::vector<std::size_t> surface_;
  std::map<std::size_t, int> cells_of_;
  std::map<std::size_t, int> grown_cells_of_;
};

}  // namespace nextview
