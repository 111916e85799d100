#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapper/voxel_grid.h"

namespace nextview {

/// Finds for every cell of a box its Chebyshev distance (the larger of |dx|, |dy|, |dz|) to the
/// nearest obstacle, or kLargest when that is farther. What lies beyond the box counts as free.
///
/// The distance is the number of moves a king of 3-D chess needs. Moves can be made in any order,
/// so let him make those along x alone first, then those along x and y, then those along all three.
/// Beginning at the obstacles that is
///
///     along z   D(x, y, z) = min(D, 1 + the least of the 3 x 3 cells around (x, y, z -+ 1))
///     along y   D(x, y, z) = min(D, 1 + the least of the 3 cells around (x, y -+ 1, z))
///     along x   D(x, y, z) = min(D, |i| + D(x + i, y, z)), by doubling: |i| = 1, 2, 4, 8, 16
///
/// each a plain loop over rows of bytes.
class ChebyshevDistance {
 public:
  static constexpr std::uint8_t kLargest = 31;

  /// A box of cells, to be filled by rows along x: 0 for an obstacle, kLargest for all others.
  void resize(const VoxelIndex& cells);
  std::uint8_t* row(int y, int z) {
    return &distances_[kMargin + static_cast<std::size_t>(z) * (layer_ + kMargin) +
                       static_cast<std::size_t>(y) * stride_];
  }

  /// Replaces what the rows were filled with by distances.
  void find();

  std::size_t memory_bytes() const {
    return distances_.capacity() + narrowed_.capacity() + lowered_.capacity();
  }

 private:
  // Loops run over all rows of a layer as if they were one long row. So many free cells lie between
  // the rows that he who crosses them has made kLargest moves, and does no harm; and as many
  // between the layers, which nothing is ever written to.
  static constexpr std::size_t kMargin = 32;
  static_assert(kMargin > kLargest);

  void lower_layer(int z, int from_z);
  void lower_rows(int y, int from_y);
  void lower_along_rows(int z);

  int rows_ = 0;
  int layers_ = 0;
  std::size_t stride_ = 0;  ///< of a row and its margin
  std::size_t layer_ = 0;   ///< of all rows of a layer
  std::vector<std::uint8_t> distances_;
  std::vector<std::uint8_t> narrowed_;  ///< a layer, and a row more on both sides
  std::vector<std::uint8_t> lowered_;
};

}  // namespace nextview
