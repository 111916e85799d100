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

Block block_of(const VoxelMap& map, const VoxelIndex& index) {
  Block block;
  block.index.assign(index.data(), index.data() + 3);
  block.labels.reserve(kLabelsBytes);
  const MapWindow box{kBlockSide * index, VoxelIndex::Constant(kBlockSide)};
  for_each_voxel(box, [&](const VoxelIndex& voxel) {
    const Label label = map.label(voxel);
    block.labels.push_back(static_cast<std::uint8_t>(label));
    if (label != Label::Occupied) return;
    const SurfaceVoxel* const surface = map.surface(voxel);
    const SurfaceVoxel known = surface == nullptr ? SurfaceVoxel{} : *surface;
    const Eigen::Vector3f normal = known.mean_normal().cast<float>();
    block.normals.emplace_back(normal.data(), normal.data() + 3);
    block.qualities.push_back(static_cast<float>(known.quality_01()));
  });
  return block;
}

map_blocks_t empty_part(const VoxelMap& map, int view, int since_view, std::int64_t utime) {
  map_blocks_t part{};
  part.utime = utime;
  part.view = view;
  part.since_view = since_view;
  part.voxel_size_m = map.grid().voxel_size_m;
  for (int axis = 0; axis < 3; ++axis) {
    part.map_origin_m[axis] = map.grid().origin_m[axis];
    part.window_min[axis] = map.window().min[axis];
    part.window_size[axis] = map.window().size[axis];
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

}  // namespace

std::vector<map_blocks_t> map_blocks_messages(const VoxelMap& map, const BlockHistory& history,
                                              int view, int since_view, std::int64_t utime) {
  const map_blocks_t empty = empty_part(map, view, since_view, utime);
  std::vector<map_blocks_t> parts = {empty};
  std::size_t bytes = 0;
  for (const std::uint32_t number : history.changed_since(since_view)) {
    Block block = block_of(map, history.blocks().coordinate(number));
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

}  // namespace nextview
