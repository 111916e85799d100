#pragma once

#include <cstdint>
#include <span>

#include "mapper/voxel_map.h"
#include "planner/prediction/free_space_field.h"
#include "planner/prediction/surface_table.h"

namespace nextview {

/// A voxel map as planning reads it: the map, and what is derived from it to be read quickly, kept
/// in step. Whoever predicts views or looks for free space is given one of these and not a map, so
/// that nobody can hold a derived thing of another map or of an earlier moment.
class KnownSpace {
 public:
  enum class Surfaces : std::uint8_t {
    Leave,
    Keep,  ///< normals and qualities too, which f_quality and f_structure ask for (P17, P18)
  };

  /// Derives all of it from a map, which must outlive this object.
  /// @param threads how many may work at a time, here and in update(), at least 1
  /// @throws std::invalid_argument when the window is too large for a FreeSpaceField
  explicit KnownSpace(const VoxelMap& map, Surfaces surfaces = Surfaces::Leave, int threads = 1);
  KnownSpace(const KnownSpace&) = delete;
  KnownSpace& operator=(const KnownSpace&) = delete;

  /// To be called after every change of the map, with the slots whose label is different and those
  /// whose surface data is (FoldReport has both), and after every move of its window with what
  /// MapBuilder::move_window says.
  void update(std::span<const std::uint32_t> changed_slots,
              std::span<const std::uint32_t> updated_surfaces);

  const VoxelMap& map() const { return map_; }
  const FreeSpaceField& field() const { return field_; }
  bool keeps_surfaces() const { return surfaces_kept_ == Surfaces::Keep; }
  /// @throws std::logic_error unless surfaces are kept
  const SurfaceTable& surfaces() const;

 private:
  const VoxelMap& map_;
  Surfaces surfaces_kept_;
  FreeSpaceField field_;
  SurfaceTable surfaces_;
};

}  // namespace nextview
