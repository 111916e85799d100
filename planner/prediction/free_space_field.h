#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mapper/lazy_array.h"
#include "mapper/voxel_map.h"
#include "planner/prediction/chebyshev_distance.h"

namespace nextview {

/// The labels of a map's window as a ray walk wants to read them: one byte a voxel says either what
/// ends the walk here, or how far it may jump.
///
///     kOccupied, kOcclusionPlane, kUnseen   a voxel that is not Empty
///     kOutside                              the layer of voxels around the window
///     d, 1 <= d <= kMaxJump                 an Empty voxel; all voxels nearer than d in the
///                                           Chebyshev sense (the larger of |di|, |dj|, |dk|) are
///                                           Empty too, so a line may advance d steps at once
///
/// d is the Chebyshev distance to the nearest voxel that is not Empty, or kMaxJump when that is
/// farther (of all_empty() it may be less). Of the bytes that end a walk the bits of kMaxJump are
/// 0: a walk adds them to its steps without asking. The sides of the field are powers of two, so an
/// offset is made by shifts; unlike the map's buffer it has a layer around the window, so that a
/// walk needs no test for the limit. Only the box around what changed is worked out again
/// (chebyshev_distance.h), and what nobody has seen takes no memory (lazy_array.h). So the field
/// keeps its own layout, relative to the window; when that moves, what stays is copied.
class FreeSpaceField {
 public:
  static constexpr std::uint8_t kMaxJump = ChebyshevDistance::kLargest;
  static constexpr std::uint8_t kOccupied = 1 * (kMaxJump + 1);
  static constexpr std::uint8_t kOcclusionPlane = 2 * (kMaxJump + 1);
  static constexpr std::uint8_t kUnseen = 3 * (kMaxJump + 1);
  static constexpr std::uint8_t kOutside = 4 * (kMaxJump + 1);

  /// The field of a whole map.
  /// @param threads how many may work at a time, here and in update(), at least 1
  /// @throws std::invalid_argument when it would need 2 GiB or more
  explicit FreeSpaceField(const VoxelMap& map, int threads = 1);
  /// The field of a window in which all is Empty, and of which only what update() changes takes
  /// memory: distances are those above around what has changed, and 1 elsewhere, which holds
  /// everywhere and lets a walk go on step by step.
  /// @throws std::invalid_argument as above
  static FreeSpaceField all_empty(const MapWindow& window, int threads = 1);

  /// Follows the map after a change of the labels at these slots (and of no others) or, and, a move
  /// of its window: then they are those of voxels that were inside before and still are.
  void update(const VoxelMap& map, std::span<const std::uint32_t> changed_slots);

  const MapWindow& window() const { return window_; }
  /// Where the byte of a voxel lies; valid in the window and one layer around it.
  std::size_t offset(const VoxelIndex& index) const {
    const VoxelIndex cell = index - window_.min + VoxelIndex::Ones();
    return static_cast<std::size_t>(cell[0]) + (static_cast<std::size_t>(cell[1]) << shift_[1]) +
           (static_cast<std::size_t>(cell[2]) << shift_[2]);
  }
  /// The voxel whose byte lies at an offset; the inverse of offset().
  VoxelIndex index_of(std::size_t offset) const {
    const auto x = static_cast<int>(offset & ((std::size_t{1} << shift_[1]) - 1));
    const auto yz = static_cast<int>(offset >> shift_[1]);
    const int z_shift = shift_[2] - shift_[1];
    return window_.min + VoxelIndex(x - 1, (yz & ((1 << z_shift) - 1)) - 1, (yz >> z_shift) - 1);
  }
  std::uint8_t at(const VoxelIndex& index) const { return bytes_[offset(index)]; }
  /// The Chebyshev distance within which everything around a voxel is Empty; 0 when it is not
  /// itself.
  int free_distance(const VoxelIndex& index) const { return at(index) & kMaxJump; }
  /// How many steps a walk that starts in a voxel may take at once, at least 1: the first step
  /// leaves the voxel whatever it is.
  int steps_from(const VoxelIndex& index) const { return std::max(free_distance(index), 1); }
  /// All bytes, with three more behind the last so that four can be read from any offset.
  const std::uint8_t* bytes() const { return bytes_.data(); }
  /// How many offsets there are; only those of the window and one layer around it are valid.
  std::size_t size() const { return bytes_.size() - 3; }
  /// log2 of the distance in bytes between neighbours along x, y, z.
  std::array<int, 3> shifts() const { return shift_; }
  std::size_t memory_bytes() const { return bytes_.memory_bytes() + distance_.memory_bytes(); }

 private:
  // Boxes of cells; a cell is a voxel's index relative to the layer around the window.
  struct Box {
    VoxelIndex min;
    VoxelIndex end;

    void add(const VoxelIndex& cell) {
      min = min.cwiseMin(cell);
      end = end.cwiseMax(cell + VoxelIndex::Ones());
    }
  };

  FreeSpaceField(const MapWindow& window, std::uint8_t everywhere, int threads);

  static std::uint8_t byte_of(Label label);
  LazyArray<std::uint8_t> filled_with(std::uint8_t everywhere) const;
  std::uint8_t* row(int y, int z) {
    return &bytes_[(static_cast<std::size_t>(y) << shift_[1]) +
                   (static_cast<std::size_t>(z) << shift_[2])];
  }
  // Follows a move of the window; the labels of what it has entered are read from the map. Widens a
  // box as below.
  void move(const VoxelMap& map, Box& changed);
  // Reads the labels again and widens a box by the cells that have become Empty or are so no
  // longer. To be called by all threads of an OpenMP region, or outside of one; and so is the next.
  void take_labels(const VoxelMap& map, std::span<const std::uint32_t> changed_slots, Box& changed);
  void find_distances(const Box& changed);

  MapWindow window_;
  VoxelIndex cells_;  ///< window and layer; along x some more that are outside
  std::array<int, 3> shift_;
  LazyArray<std::uint8_t> bytes_;
  ChebyshevDistance distance_;  ///< workspace
  int threads_;
};

}  // namespace nextview
