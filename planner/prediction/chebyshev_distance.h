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

  /// A box of cells, all rows of which are to be filled next.
  /// @param threads how many will call find()
  void resize(const VoxelIndex& cells, int threads = 1);
  /// Fills the row along x at (y, z): bytes up to largest_free are free cells, others obstacles.
  void fill_row(int y, int z, const std::uint8_t* bytes, std::uint8_t largest_free);
  /// The distances along x at (y, z), after find().
  const std::uint8_t* row(int y, int z) const { return &distances_[place(y, z)]; }

  /// Replaces what the rows were filled with by distances. To be called by all threads of an OpenMP
  /// region, or outside of one. Of several threads one goes along z, a quarter to a third of the
  /// work, and then all share the layers. The result is the same.
  void find();

  std::size_t memory_bytes() const { return distances_.capacity(); }

 private:
  // Loops run over all rows of a layer as if they were one long row. So many free cells lie between
  // the rows that he who crosses them has made kLargest moves, and does no harm; and as many
  // between the layers, which nothing is ever written to.
  static constexpr std::size_t kMargin = 32;
  static_assert(kMargin > kLargest);

  using Bytes = std::vector<std::uint8_t>;
  // A layer to work with, and a row more on both sides.
  Bytes free_layer() const { return Bytes(layer_ + 2 * stride_, kLargest); }

  std::size_t place(int y, int z) const {
    return kMargin + static_cast<std::size_t>(z) * (layer_ + kMargin) +
           static_cast<std::size_t>(y) * stride_;
  }
  void lower_layers();
  void finish_layers(int begin_z, int end_z);
  void lower_layer(int z, int from_z, Bytes& narrowed);
  void lower_rows(int y, int from_y, int begin_z, int end_z);
  void lower_along_rows(int z, Bytes& a, Bytes& b);

  VoxelIndex cells_ = VoxelIndex::Zero();
  int rows_ = 0;
  int layers_ = 0;
  std::size_t stride_ = 0;  ///< of a row and its margin
  std::size_t layer_ = 0;   ///< of all rows of a layer
  int threads_ = 1;
  Bytes distances_;
};

}  // namespace nextview
