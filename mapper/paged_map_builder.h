#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mapper/block_content.h"
#include "mapper/map_statistics.h"
#include "mapper/voxel_map.h"
#include "sensor/range_image.h"

namespace nextview {

/// A map larger than the window that lies open in memory: the same map as MapBuilder's over the
/// whole of it, bit for bit, in labels, surface data, areas, quality and digest.
///
/// The window follows the sensor. What it leaves is kept aside, packed block by block, and comes
/// back as it was; what rays free, hit or hide outside the window is marked there (block_store.h).
/// Rays are followed to the limit of the extent, not of the window, so nothing depends on where the
/// window lies or how large it is but memory and time. Voxels are worked on as bits, one line after
/// the other, which takes longer than MapBuilder does in one buffer (bench/README.md).
class PagedMapBuilder {
 public:
  /// An all-Unmarked map.
  /// @param extent      what the map covers: where rays end, and what is counted and hashed
  /// @param window_size voxels that are to lie open, rounded up to blocks of 8; what is beyond the
  ///                    extent is not used
  /// @throws std::invalid_argument unless the voxel size is positive and finite, every side of the
  ///         extent in [1, 16384], its volume below 2^31 voxels, and every side of the window at
  ///         least 1
  PagedMapBuilder(const VoxelGrid& grid, const MapWindow& extent, const VoxelIndex& window_size);
  ~PagedMapBuilder();
  PagedMapBuilder(PagedMapBuilder&&) noexcept;
  PagedMapBuilder& operator=(PagedMapBuilder&&) noexcept;

  /// Updates the map by one range image (P12).
  /// @throws std::invalid_argument as MapBuilder::fold does, the map unchanged
  FoldCounts fold(const RangeImage& image);

  const VoxelGrid& grid() const;
  const MapWindow& extent() const;
  /// What lies open: whole blocks, which may stick out of the extent.
  MapWindow window() const;

  /// Of a voxel wherever it lies; Unmarked outside the extent.
  Label label(const VoxelIndex& voxel) const;
  /// Of an Occupied voxel wherever it lies, else nullptr; valid until the next fold.
  const SurfaceVoxel* surface(const VoxelIndex& voxel) const;

  /// All there is in a block, wherever it lies.
  BlockContent block(const VoxelIndex& coordinate) const;
  /// Coordinates of the blocks that have changed, in label or surface, since so many images were
  /// folded, in their order, x fastest.
  std::vector<VoxelIndex> changed_since(int folds) const;

  MapStatistics statistics() const;  ///< of the whole map
  std::string digest();              ///< of the whole map, as MapBuilder's

  std::size_t blocks_aside() const;
  /// Bytes of heap memory in use.
  std::size_t memory_bytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nextview
