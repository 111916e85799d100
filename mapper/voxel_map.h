#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "mapper/lazy_array.h"
#include "mapper/voxel_grid.h"

namespace nextview {

/// What is known of a voxel (P8). The order is the rule of the map update: of two marks the larger
/// stays (a hit beats a miss, and whatever was seen beats what was hidden), in any order of rays.
/// OcclusionPlane is not a mark of its own: it is derived from Occluded after every range image.
enum class Label : std::uint8_t {
  Unmarked = 0,        ///< never observed
  Occluded = 1,        ///< so far hidden behind an Occupied voxel
  OcclusionPlane = 2,  ///< Occluded, and one of its six faces touches an Empty voxel
  Empty = 3,           ///< observed, empty
  Occupied = 4,        ///< sensed points fell in it
};
constexpr std::size_t kLabelCount = 5;

/// What is kept of the surface in an Occupied voxel (P9). Integers, so that the sums do not depend
/// on the order of the points.
struct SurfaceVoxel {
  /// A unit normal's components are rounded to multiples of 1/kNormalUnit before they are summed.
  static constexpr int kNormalUnit = 1 << 14;
  /// Quality 1.0 (surface seen head-on) as stored.
  static constexpr int kQualityUnit = 65535;

  std::array<std::int64_t, 3> normal_sum = {0, 0, 0};  ///< world frame, towards the sensor
  std::uint32_t normal_count = 0;                      ///< points that had a normal
  std::uint16_t quality = 0;  ///< best |cos(normal, viewing ray)| so far, in 1/kQualityUnit

  double quality_01() const { return static_cast<double>(quality) / kQualityUnit; }
  /// Unit vector along the sum; zero when no point had a normal or the normals cancel.
  Eigen::Vector3d mean_normal() const;
};

/// The voxel map (P8-P10): a dense 3-D circular buffer of labels, and sparse surface data beside
/// it.
///
/// The buffer's sides are powers of two and a voxel's slot is its index under a mask per axis, so a
/// voxel keeps its slot when the window moves and no data moves in memory. Slots run x fastest:
///   slot = (i & mask_x) | (j & mask_y) << shift_y | (k & mask_z) << shift_z.
/// Per voxel: 1 byte of label, of which pages that nobody has written to take no memory
/// (lazy_array.h), 1/64 byte of block table; per 8 x 8 x 8 block that holds a surface 1 KiB, and 32
/// bytes per Occupied voxel.
class VoxelMap {
 public:
  /// A map of one label, by default all Unmarked.
  /// @throws std::invalid_argument unless the voxel size is positive and finite and every side of
  ///         the window is in [1, 4096] with at most 2^31 slots in all
  VoxelMap(const VoxelGrid& grid, const MapWindow& window, Label everywhere = Label::Unmarked);

  const VoxelGrid& grid() const { return grid_; }
  const MapWindow& window() const { return window_; }
  bool contains(const VoxelIndex& index) const { return window_.contains(index); }

  /// The label of a voxel; Unmarked outside the window.
  Label label(const VoxelIndex& index) const {
    return contains(index) ? labels_[slot(index)] : Label::Unmarked;
  }
  /// Sets a label. The index must lie inside the window.
  void set_label(const VoxelIndex& index, Label label) { labels_[slot(index)] = label; }

  /// The surface data of an Occupied voxel, or nullptr when it has none or lies outside.
  const SurfaceVoxel* surface(const VoxelIndex& index) const;
  /// The surface data of a voxel inside the window, created when absent.
  SurfaceVoxel& surface_at(const VoxelIndex& index);

  /// Moves the window so that it starts at new_min, its size unchanged. What the window leaves is
  /// forgotten and what it enters reads Unmarked; everything in both stays where it is in memory.
  void move_window(const VoxelIndex& new_min);

  /// Raw access for the fast paths: the slot of a voxel, and all labels by slot.
  std::size_t slot(const VoxelIndex& index) const {
    return static_cast<std::size_t>(index[0] & mask_[0]) |
           static_cast<std::size_t>(index[1] & mask_[1]) << shift_[1] |
           static_cast<std::size_t>(index[2] & mask_[2]) << shift_[2];
  }
  /// The voxel of the window that a slot holds; the inverse of slot(). Only of slots in use.
  VoxelIndex index_of_slot(std::size_t slot) const {
    VoxelIndex index;
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const int low = static_cast<int>(slot >> shift_[a]) & mask_[a];
      index[axis] = window_.min[axis] + ((low - window_.min[axis]) & mask_[a]);
    }
    return index;
  }
  std::span<Label> labels() { return {labels_.data(), labels_.size() - kLabelPadding}; }
  std::span<const Label> labels() const { return {labels_.data(), labels_.size() - kLabelPadding}; }
  /// Calls see(slot, label) for all voxels that are not Unmarked, in the order of their slots.
  template <typename See>
  void for_each_marked(See see) const;
  /// The label of any slot may be read as the first byte of a word: this many bytes follow the
  /// last.
  static constexpr std::size_t kLabelPadding = 3;
  /// Sides of the buffer, powers of two no smaller than the window's.
  std::array<int, 3> sides() const { return {mask_[0] + 1, mask_[1] + 1, mask_[2] + 1}; }
  std::array<int, 3> shifts() const { return shift_; }

  /// Bytes of heap memory in use.
  std::size_t memory_bytes() const;

 private:
  struct SurfaceBlock {
    static constexpr std::uint16_t kNone = 0xffff;
    std::array<std::uint16_t, kBlockVoxels> entry;  ///< into voxels
    std::vector<SurfaceVoxel> voxels;
  };

  std::size_t block_of_slot(const VoxelIndex& index) const;
  static std::size_t entry_in_block(const VoxelIndex& index);
  void forget(const VoxelIndex& index);

  VoxelGrid grid_;
  MapWindow window_;
  std::array<int, 3> mask_;
  std::array<int, 3> shift_;
  LazyArray<Label> labels_;
  std::vector<std::unique_ptr<SurfaceBlock>> blocks_;  ///< by slot / kBlockSide per axis
};

template <typename See>
void VoxelMap::for_each_marked(See see) const {
  const std::span<const Label> all = labels();
  std::size_t slot = 0;
  while (slot < all.size()) {
    std::uint64_t eight = 0;
    if (slot + sizeof(eight) <= all.size()) {
      std::memcpy(&eight, &all[slot], sizeof(eight));
      if (eight == 0) {
        slot += sizeof(eight);
        continue;
      }
    }
    // Slots between the window's sides and those of the buffer are nobody's.
    if (all[slot] != Label::Unmarked && contains(index_of_slot(slot))) see(slot, all[slot]);
    ++slot;
  }
}

}  // namespace nextview
