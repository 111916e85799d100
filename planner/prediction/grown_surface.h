#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mapper/lazy_array.h"
#include "mapper/voxel_map.h"
#include "planner/prediction/free_space_field.h"

namespace nextview {

/// Where surfaces are likely to go on: every Occupied voxel's plane, grown from its edge into what
/// is unknown.
///
///     . . . . ? ? ?        # Occupied, its normal upwards    . Empty    ? unknown
///     # # # # g g g ...    g grown, p = exp(-l / kDecay_m), l the distance from the last #
///     ? ? ? ? ? ? ?
///
/// A plane consists of the voxels whose centres lie within half a voxel of it. It goes on through
/// unknown voxels, through up to two Empty ones that have unknown ones behind them (a surface seen
/// at a grazing angle leaves such; half as likely), ends at Occupied ones, at another plane that is
/// nearer to its own surface, and after kReach_m.
class GrownSurface {
 public:
  static constexpr double kDecay_m = 2.0;
  static constexpr double kReach_m = 4.0;
  static constexpr std::int32_t kCertain = 1 << 16;  ///< likelihood 1

  /// Grows from all of a map.
  explicit GrownSurface(const VoxelMap& map);

  /// Follows the map after these slots became known or unknown or Occupied: the planes that begin
  /// within reach of them grow again.
  void update(const VoxelMap& map, std::span<const std::uint32_t> changed_slots);

  /// Offsets as of the map's own field; grown (kOcclusionPlane) and Occupied voxels stop a ray, all
  /// others do not.
  const FreeSpaceField& field() const { return field_; }
  /// The same, but that unknown voxels that are not grown stop a ray too (kUnseen): what it meets
  /// there is the first that can be new in any way.
  const FreeSpaceField& unknown_too() const { return unknown_too_; }
  /// Of a voxel to be surface, 1/kCertain; 0 where no plane grows.
  std::int32_t likelihood(std::size_t offset) const { return likelihood_[offset]; }
  /// Slots whose likelihood the last update changed.
  std::span<const std::uint32_t> changed() const { return changed_; }
  std::size_t size() const { return grown_.size(); }
  /// Those grown voxels that are Empty: there a ray meets something that the map says is not there.
  const std::vector<VoxelIndex>& bridges() const { return bridges_; }
  /// Of what is kept for each voxel of the window: it grows with what was seen.
  std::size_t memory_bytes() const;

 private:
  struct Plane {
    VoxelIndex from;  // the Occupied voxel it grows from
    Eigen::Vector3f normal;
    float half_thickness;  // in voxels along the normal
  };
  struct Growing {
    VoxelIndex voxel;
    std::uint32_t plane;
    std::int8_t empty;  // voxels passed since the last that was not Empty
  };
  struct Grown {
    std::uint32_t slot;
    VoxelIndex from;
  };

  void grow(const VoxelMap& map, const VoxelIndex& min, const VoxelIndex& end);
  void follow_unknown(const VoxelMap& map, std::span<const std::uint32_t> changed_slots);
  void add_plane(const VoxelMap& map, const VoxelIndex& voxel);
  void step_from(const VoxelMap& map, const Growing& at, std::size_t bucket);
  bool in_plane(const Plane& plane, const VoxelIndex& voxel) const;

  int reach_;                              // voxels
  std::vector<std::int32_t> by_distance_;  // likelihood by squared distance in voxels
  VoxelMap expected_;                      // Occupied, grown as OcclusionPlane, Empty
  FreeSpaceField field_;
  VoxelMap with_unknown_;  // the same, what is unknown else as Unmarked
  FreeSpaceField unknown_too_;
  LazyArray<std::int32_t> likelihood_;  // by offset
  std::vector<Grown> grown_;
  std::vector<VoxelIndex> bridges_;
  std::vector<std::uint32_t> changed_;
  std::vector<Plane> planes_;                  // of the growth under way
  std::vector<std::vector<Growing>> buckets_;  // by squared distance
};

}  // namespace nextview
