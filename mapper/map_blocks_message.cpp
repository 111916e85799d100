#include "mapper/map_blocks_message.h"

#include <algorithm>
#include <utility>

namespace nextview {
namespace {

constexpr std::size_t kLabelsBytes = kBlockVoxels;
constexpr std::size_t kBlockBytes = 3 * sizeof(std::int32_t) + kLabelsBytes;
constexpr std::size_t kSurfaceBytes = 4 * sizeof(float);
/// Of blocks and surfaces in a part: as of a range image. A block full of surfaces has a sixth.
constexpr std::size_t kPartBytes = 48 * 1024;
static_assert(kPartBytes + 1024 < kMaxMessageBytes);
static_assert(kBlockBytes + kBlockVoxels * kSurfaceBytes < kPartBytes);

/// A block by itself, in the form of the message.
struct Block {
  std::vector<std::int32_t> index;
  std::vector<std::uint8_t> labels;
  std::vector<std::vector<float>> normals;
  std::vector<float> qualities;

  std::size_t bytes() const { return kBlockBytes + kSurfaceBytes * qualities.size(); }
};

Block block_of(const VoxelIndex& index, const BlockContent& content) {
  Block block;
  block.index.assign(index.data(), index.data() + 3);
  block.labels.assign(content.labels.begin(), content.labels.end());
  for (const SurfaceVoxel& surface : content.surfaces) {
    const Eigen::Vector3f normal = surface.mean_normal().cast<float>();
    block.normals.emplace_back(normal.data(), normal.data() + 3);
    block.qualities.push_back(static_cast<float>(surface.quality_01()));
  }
  return block;
}

BlockContent content_of(const VoxelMap& map, const VoxelIndex& index) {
  BlockContent content;
  std::size_t entry = 0;
  const MapWindow box{kBlockSide * index, VoxelIndex::Constant(kBlockSide)};
  for_each_voxel(box, [&](const VoxelIndex& voxel) {
    const Label label = map.label(voxel);
    content.labels[entry++] = static_cast<std::uint8_t>(label);
    if (label != Label::Occupied) return;
    const SurfaceVoxel* const surface = map.surface(voxel);
    content.surfaces.push_back(surface == nullptr ? SurfaceVoxel{} : *surface);
  });
  return content;
}

map_blocks_t empty_part(const VoxelGrid& grid, const MapWindow& window, int view, int since_view,
                        std::int64_t utime) {
  map_blocks_t part{};
  part.utime = utime;
  part.view = view;
  part.since_view = since_view;
  part.voxel_size_m = grid.voxel_size_m;
  for (int axis = 0; axis < 3; ++axis) {
    part.map_origin_m[axis] = grid.origin_m[axis];
    part.window_min[axis] = window.min[axis];
    part.window_size[axis] = window.size[axis];
  }
  return part;
}

void append(map_blocks_t& part, Block block) {
  ++part.blocks;
  part.surfaces += static_cast<std::int32_t>(block.qualities.size());
  part.block_index.push_back(std::move(block.index));
  part.block_label.push_back(std::move(block.labels));
  std::ranges::move(block.normals, std::back_inserter(part.surface_normal));
  std::ranges::move(block.qualities, std::back_inserter(part.surface_quality));
}

// @param content_at (coordinate of a block) -> BlockContent
template <class ContentAt>
std::vector<map_blocks_t> parts_of(const map_blocks_t& empty,
                                   const std::vector<VoxelIndex>& changed, ContentAt content_at) {
  std::vector<map_blocks_t> parts = {empty};
  std::size_t bytes = 0;
  for (const VoxelIndex& index : changed) {
    Block block = block_of(index, content_at(index));
    if (bytes + block.bytes() > kPartBytes) {
      parts.push_back(empty);
      bytes = 0;
    }
    bytes += block.bytes();
    append(parts.back(), std::move(block));
  }
  for (std::size_t part = 0; part < parts.size(); ++part) {
    parts[part].part = static_cast<std::int32_t>(part);
    parts[part].parts = static_cast<std::int32_t>(parts.size());
  }
  return parts;
}

}  // namespace

std::vector<map_blocks_t> map_blocks_messages(const VoxelMap& map, const BlockHistory& history,
                                              int view, int since_view, std::int64_t utime) {
  std::vector<VoxelIndex> changed;
  for (const std::uint32_t number : history.changed_since(since_view)) {
    changed.push_back(history.blocks().coordinate(number));
  }
  return parts_of(empty_part(map.grid(), map.window(), view, since_view, utime), changed,
                  [&](const VoxelIndex& index) { return content_of(map, index); });
}

std::vector<map_blocks_t> map_blocks_messages(const PagedMapBuilder& builder, int view,
                                              int since_view, std::int64_t utime) {
  return parts_of(empty_part(builder.grid(), builder.extent(), view, since_view, utime),
                  builder.changed_since(since_view),
                  [&](const VoxelIndex& index) { return builder.block(index); });
}

}  // namespace nextview
