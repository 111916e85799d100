#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mapper/voxel_map.h"
#include "planner/prediction/free_space_field.h"
#include "planner/prediction/predicted_quality.h"
#include "planner/prediction/view_counts.h"

namespace nextview {

/// What f_quality and f_structure ask of the Occupied voxels, found by where a ray ended in a
/// FreeSpaceField:
/// normal and quality lie densely by a surface number, and a sparse table of pages leads from an
/// offset to the number. The offset and not the map's slot, which would not change when the window
/// moves: to work that out for every ray took 10 to 17 % of a decision with f_quality, and a move
/// is rare.
class SurfaceTable {
 public:
  struct Surface {
    QuantisedDirection normal = {0, 0, 0};  ///< of the mean; zero when there is none
    std::uint16_t quality = 0;              ///< best so far, 1/SurfaceVoxel::kQualityUnit
  };

  SurfaceTable() = default;

  /// Takes the surface data of these slots of the map, those that are not Occupied left out.
  void update(const VoxelMap& map, const FreeSpaceField& field,
              std::span<const std::uint32_t> slots);
  /// Follows a field that has moved by a step, and forgets what it has left.
  void move(const FreeSpaceField& field, const VoxelIndex& step);

  /// The number of the Occupied voxel at an offset of the field.
  std::uint32_t number_at(std::size_t offset) const {
    return (*pages_[offset / kPageSize])[offset % kPageSize];
  }
  const Surface& operator[](std::uint32_t number) const { return surfaces_[number]; }
  /// How many voxels it knows.
  std::size_t size() const { return surfaces_.size() - free_.size(); }

 private:
  static constexpr std::size_t kPageSize = 512;
  static constexpr std::uint32_t kNone = 0xffffffff;
  using Page = std::array<std::uint32_t, kPageSize>;

  std::uint32_t& entry(std::size_t offset);
  std::uint32_t new_number();

  std::vector<std::unique_ptr<Page>> pages_;
  std::vector<Surface> surfaces_;
  std::vector<std::uint32_t> free_;  ///< numbers of what was forgotten
};

/// Counts the distinct Occupied voxels of one view after the other: what it would gain, and how
/// their normals are spread.
class SurfaceCount {
 public:
  /// One ray of the view at hand met an Occupied voxel.
  void add(std::uint32_t surface, std::int32_t cosine) {
    if (surface >= seen_in_.size()) {
      seen_in_.resize(surface + surface / 2 + 64, 0);
      best_.resize(seen_in_.size());
    }
    if (seen_in_[surface] != view_) {
      seen_in_[surface] = view_;
      best_[surface] = cosine;
      met_.push_back(surface);
    } else if (cosine > best_[surface]) {
      best_[surface] = cosine;
    }
  }
  /// Writes the surface counts of the view and begins the next.
  void finish(const SurfaceTable& surfaces, ViewCounts& counts);

 private:
  std::uint64_t view_ = 1;
  std::vector<std::uint64_t> seen_in_;  // by surface: the last view that met it
  std::vector<std::int32_t> best_;      // and its best cosine there
  std::vector<std::uint32_t> met_;
};

}  // namespace nextview
