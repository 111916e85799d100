#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapper/integer_line.h"
#include "mapper/voxel_map.h"

namespace nextview {

/// Stretches of sixteen voxel lines, to be walked side by side.
///
/// Lines from one sensor to neighbouring ends run through the same voxels for much of their way.
/// Walked in step, such a voxel turns up in neighbouring lanes at once and is named only once:
///
///     line 0   a b d g         step by step:  a | b c | d e | g h i
///     line 1   a b d h
///     line 2   a b e i
///     line 3   a c e i
class LineBundle {
 public:
  static constexpr std::size_t kLines = 16;

  /// For lines in this map, or another of the same shape.
  explicit LineBundle(const VoxelMap& map);

  /// Adds the voxels k = first ... last of a line; they must lie inside the window. None if last <
  /// first. The bundle must not be full.
  void add(const IntegerLine& line, int first, int last);
  bool full() const { return size_ == kLines; }

  struct Slots {
    std::uint32_t* begin;
    std::size_t size;
  };
  /// Empties the bundle, and returns the slots of all voxels of all its stretches whose labels are
  /// below a given one, each at least once. What repeats, and how often, depends on the instruction
  /// set; the order in which slots turn up first does not.
  /// @return valid until the next call; the caller may write to it
  Slots take_slots(const VoxelMap& map, Label below);

  /// What the kernel needs of the map: IntegerLine::at in slots.
  struct Layout {
    std::array<std::int32_t, 3> mask;
    std::array<int, 3> shift;
  };
  /// The stretches in columns; fixed-point positions wrap, which the masks make good.
  struct Stretches {
    alignas(64) std::array<std::array<std::int32_t, kLines>, 3> position = {};
    alignas(64) std::array<std::array<std::int32_t, kLines>, 3> slope = {};
    alignas(64) std::array<std::int32_t, kLines> voxels = {};  ///< how many, per line
  };

 private:
  Layout layout_;
  Stretches stretches_;
  std::size_t size_ = 0;
  std::int32_t longest_ = 0;
  std::vector<std::uint32_t> slots_;
};

}  // namespace nextview
