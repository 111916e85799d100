#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mapper/normals.h"
#include "mapper/row_ends.h"

namespace nextview {

/// A run of neighbouring pixels whose rays end alike, and the sums over their normals.
struct PixelRun {
  std::int32_t begin;  ///< columns begin ... end - 1
  std::int32_t end;
  std::int32_t normal_sum[4];  ///< x, y, z, and how many pixels have a normal
  std::int32_t quality;        ///< the best
};

/// The runs of a row, each as long as it can be, but none across a multiple of 65536 columns, so
/// that sums fit. Pixels of different kinds share no run; where rays leave the window is no matter.
class PixelRuns {
 public:
  /// @return the runs from left to right; valid until the next call
  std::span<const PixelRun> find(int columns, const RowEnds& ends, const NormalRow& normals);

  /// The columns whose ray ends or leaves the window elsewhere than the ray to the left and the ray
  /// above do: all others have a line beyond their end that one of these two has.
  /// @return from left to right; valid until the next call of either function
  std::span<const std::int32_t> find_other_lines(int columns, const RowEnds& ends,
                                                 const RowEnds& above);

  std::size_t memory_bytes() const {
    return runs_.capacity() * sizeof(PixelRun) + columns_.capacity() * sizeof(std::int32_t);
  }

 private:
  std::vector<std::int32_t> columns_;
  std::vector<PixelRun> runs_;
};

}  // namespace nextview
