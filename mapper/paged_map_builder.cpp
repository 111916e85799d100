#include "mapper/paged_map_builder.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "mapper/block_store.h"
#include "mapper/image_check.h"
#include "mapper/integer_line.h"
#include "mapper/quality_census.h"
#include "mapper/ray_ends.h"

namespace nextview {

namespace {

constexpr int kMaxSide = 16384;

void check(const VoxelGrid& grid, const MapWindow& extent, const VoxelIndex& window_size) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(what);
  };
  require(grid.voxel_size_m > 0.0 && std::isfinite(grid.voxel_size_m),
          "the voxel size must be a positive length in metres");
  require(grid.origin_m.allFinite(), "the map's origin must be finite");
  require(
      (extent.size.array() >= 1).all() && (extent.size.array() <= kMaxSide).all() &&
          extent.size.cast<std::int64_t>().prod() < std::int64_t{1} << 31,
      "the map's extent must be 1 to 16384 voxels along each axis and below 2^31 in all: choose "
      "larger voxels");
  require((window_size.array() >= 1).all(), "the map's window must be a voxel or more each way");
}

// Goes along voxel lines, and knows the block of the voxel it is at.
class LineWalk {
 public:
  explicit LineWalk(BlockStore& store) : store_(store) {}

  /// Calls mark(block, bit) for the voxels k = first ... last of a line.
  template <typename Mark>
  void walk(const IntegerLine& line, int first, int last, Mark mark) {
    std::int64_t position[3];
    for (int axis = 0; axis < 3; ++axis) {
      position[axis] = line.start[axis] * (std::int64_t{1} << IntegerLine::kFractionBits) +
                       IntegerLine::kHalf + std::int64_t{first} * line.slope[axis];
    }
    for (int k = first; k <= last; ++k) {
      VoxelIndex voxel;
      for (int axis = 0; axis < 3; ++axis) {
        voxel[axis] = static_cast<int>(position[axis] >> IntegerLine::kFractionBits);
        position[axis] += line.slope[axis];
      }
      mark(block_of(voxel), VoxelBit(voxel));
    }
  }

  OpenBlock& block_of(const VoxelIndex& voxel) {
    const int x = block_of_index(voxel[0]);
    const int y = block_of_index(voxel[1]);
    const int z = block_of_index(voxel[2]);
    if (block_ == nullptr || x != block_->coordinate[0] || y != block_->coordinate[1] ||
        z != block_->coordinate[2]) {
      block_ = &store_.open({x, y, z});
    }
    return *block_;
  }

 private:
  BlockStore& store_;
  OpenBlock* block_ = nullptr;
};

// The coordinate of the block at a side: -x, +x, -y, +y, -z, +z.
VoxelIndex beside(const OpenBlock& block, int side) {
  VoxelIndex coordinate = block.coordinate;
  coordinate[side / 2] += side % 2 == 0 ? -1 : 1;
  return coordinate;
}

}  // namespace

struct PagedMapBuilder::State {
  State(const VoxelGrid& grid_, const MapWindow& extent_, const VoxelIndex& window_size)
      : grid(grid_), extent(extent_), store(extent_, window_size), counts(extent_) {}

  void mark(const VoxelIndex& sensor);
  void hit(OpenBlock& block, const RayEnd& end);
  void change(OpenBlock& block) {
    block.changed_in = folds;
    note(block);
  }
  void note(OpenBlock& block) {
    block.is_marked = block.is_stale = true;
    if (block.is_noted) return;
    block.is_noted = true;
    changed.push_back(&block);
  }
  void derive();
  void note_neighbours();

  VoxelGrid grid;
  MapWindow extent;
  BlockStore store;
  MapCounts counts;
  QualityCensus quality;
  RayEnds ray_ends;
  int folds = 0;
  std::int64_t newly_occupied = 0;
  std::vector<OpenBlock*> changed;  // by the fold under way
};

PagedMapBuilder::PagedMapBuilder(const VoxelGrid& grid, const MapWindow& extent,
                                 const VoxelIndex& window_size) {
  check(grid, extent, window_size);
  state_ = std::make_unique<State>(grid, extent, window_size);
}
PagedMapBuilder::~PagedMapBuilder() = default;
PagedMapBuilder::PagedMapBuilder(PagedMapBuilder&&) noexcept = default;
PagedMapBuilder& PagedMapBuilder::operator=(PagedMapBuilder&&) noexcept = default;

FoldCounts PagedMapBuilder::fold(const RangeImage& image) {
  State& s = *state_;
  check_range_image(image, s.grid, s.extent);
  s.ray_ends.collect(image, s.grid, s.extent);  // eq. 1, eq. 2, normals (P9)
  const VoxelIndex sensor = s.grid.voxel_of(image.position_m);
  ++s.folds;
  s.store.follow(sensor);  // P10
  s.mark(sensor);          // P12, P9
  s.derive();              // occlusion planes, P13
  s.store.close_far();
  const PixelCounts& pixels = s.ray_ends.counts();
  return {pixels.points, pixels.points_outside, pixels.no_returns, pixels.invalid,
          s.newly_occupied};
}

// A mark stays unless a larger one comes (Label), so no order of the rays matters.
void PagedMapBuilder::State::mark(const VoxelIndex& sensor) {
  newly_occupied = 0;
  LineWalk lines(store);
  const auto free = [this](OpenBlock& block, const VoxelBit& at) {
    BlockLabels& labels = block.labels;
    if (at.is_in(labels.empty) || at.is_in(labels.occupied)) return;
    labels.empty[at.word] |= at.bit;
    labels.hidden[at.word] &= ~at.bit;
    change(block);
  };
  const auto hide = [this](OpenBlock& block, const VoxelBit& at) {
    BlockLabels& labels = block.labels;
    const std::uint64_t marked =
        labels.empty[at.word] | labels.occupied[at.word] | labels.hidden[at.word];
    if ((marked & at.bit) != 0) return;
    labels.hidden[at.word] |= at.bit;
    change(block);
  };
  for (const RayEnd& end : ray_ends.ends()) {
    if (end.is_surface) hit(lines.block_of(end.voxel), end);
  }
  for (const RayEnd& end : ray_ends.ends()) {
    const IntegerLine line = line_between(sensor, end.voxel);
    const int last =
        end.is_surface ? line.steps - 1 : std::min(line.steps, steps_inside(line, extent));
    lines.walk(line, 0, last, free);
  }
  for (const Shadow& shadow : ray_ends.shadows()) {
    const IntegerLine line = line_between(ray_ends.ends()[shadow.end].voxel, shadow.limit);
    lines.walk(line, 1, line.steps, hide);
  }
}

void PagedMapBuilder::State::hit(OpenBlock& block, const RayEnd& end) {
  BlockLabels& labels = block.labels;
  const VoxelBit at(end.voxel);
  const auto place =
      block.surfaces.begin() + static_cast<std::ptrdiff_t>(at.rank_in(labels.occupied));
  const bool is_new = !at.is_in(labels.occupied);
  SurfaceVoxel& surface = is_new ? *block.surfaces.insert(place, SurfaceVoxel()) : *place;
  if (is_new) {
    labels.occupied[at.word] |= at.bit;
    labels.empty[at.word] &= ~at.bit;
    labels.hidden[at.word] &= ~at.bit;
    ++newly_occupied;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    surface.normal_sum[axis] += end.seen.normal_sum[axis];
  }
  surface.normal_count += end.seen.normal_count;
  if (end.seen.quality > surface.quality) {
    quality.change(surface.quality, end.seen.quality);
    surface.quality = end.seen.quality;
  }
  if (is_new || end.seen.normal_count > 0) change(block);
}

// Of what touches an Empty voxel that has come or gone the planes and faces change too.
void PagedMapBuilder::State::note_neighbours() {
  const std::size_t marked = changed.size();
  for (std::size_t n = 0; n < marked; ++n) {
    const OpenBlock& block = *changed[n];
    BlockBits differs;
    for (std::size_t z = 0; z < differs.size(); ++z) {
      differs[z] = block.labels.empty[z] ^ block.counted_empty[z];
    }
    const unsigned sides = sides_touched(differs);
    for (int side = 0; side < 6; ++side) {
      if ((sides >> side & 1) == 0) continue;
      OpenBlock* const neighbour = store.open_marked(beside(block, side));
      if (neighbour != nullptr) note(*neighbour);
    }
  }
}

void PagedMapBuilder::State::derive() {
  note_neighbours();
  static constexpr BlockBits kNone = {};
  for (OpenBlock* const block : changed) {
    std::array<const BlockBits*, 6> beyond;
    for (int side = 0; side < 6; ++side) {
      const OpenBlock* const neighbour = store.open_marked(beside(*block, side));
      beyond[static_cast<std::size_t>(side)] = neighbour ? &neighbour->labels.empty : &kNone;
    }
    EmptyNeighbours open;
    find_empty_neighbours(block->labels, beyond, open);
    for (std::size_t z = 0; z < open.any.size(); ++z) {
      const std::uint64_t planes = block->labels.hidden[z] & open.any[z];
      if (planes != block->labels.occlusion_plane[z]) block->changed_in = folds;
      block->labels.occlusion_plane[z] = planes;
    }
    counts.take_away(block->counts);
    block->counts = counts_of(block->labels, open);
    counts.add(block->counts);
    block->counted_empty = block->labels.empty;
    block->is_noted = false;
  }
  changed.clear();
}

const VoxelGrid& PagedMapBuilder::grid() const { return state_->grid; }
const MapWindow& PagedMapBuilder::extent() const { return state_->extent; }
MapWindow PagedMapBuilder::window() const { return state_->store.window(); }
Label PagedMapBuilder::label(const VoxelIndex& voxel) const { return state_->store.label(voxel); }
const SurfaceVoxel* PagedMapBuilder::surface(const VoxelIndex& voxel) const {
  return state_->store.surface(voxel);
}

BlockContent PagedMapBuilder::block(const VoxelIndex& coordinate) const {
  return state_->store.content(coordinate);
}
std::vector<VoxelIndex> PagedMapBuilder::changed_since(int folds) const {
  return state_->store.changed_after(folds);
}

MapStatistics PagedMapBuilder::statistics() const {
  return map_statistics(state_->counts, state_->quality, state_->grid.voxel_size_m);
}

std::string PagedMapBuilder::digest() {
  HashOfBlocks whole;
  state_->store.hash(whole);
  return whole.hex_digits();
}

std::size_t PagedMapBuilder::blocks_aside() const { return state_->store.blocks_aside(); }

std::size_t PagedMapBuilder::memory_bytes() const {
  const State& s = *state_;
  return sizeof(State) + s.store.memory_bytes() + s.quality.memory_bytes() +
         s.ray_ends.memory_bytes() + s.changed.capacity() * sizeof(void*);
}

}  // namespace nextview
