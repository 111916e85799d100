#include "planner/prediction/free_space_field.h"

#include <bit>
#include <stdexcept>
#include <utility>

#include "sensor/vector_clones.h"

namespace nextview {

namespace {

using Byte = std::uint8_t;

/// Rows are worked on in whole vectors of so many bytes: what is left of a row behind its last
/// vector would take as long as all before it.
constexpr int kVector = 32;

int round_down(int size) { return size / kVector * kVector; }
int round_up(int size) { return round_down(size + kVector - 1); }

// What ends a walk stays what it is: its distance is 0. A row that stays as it was is not written
// to, so that it need not be fetched again by other cores.
NEXTVIEW_VECTOR_CLONES
void take_distances(const Byte* distances, Byte* __restrict bytes, std::size_t size) {
  Byte difference = 0;
  for (std::size_t i = 0; i < size; ++i) {
    difference =
        static_cast<Byte>(difference | ((bytes[i] & FreeSpaceField::kMaxJump) ^ distances[i]));
  }
  if (difference == 0) return;
  for (std::size_t i = 0; i < size; ++i) {
    bytes[i] = static_cast<Byte>((bytes[i] & ~FreeSpaceField::kMaxJump) | distances[i]);
  }
}

}  // namespace

std::uint8_t FreeSpaceField::byte_of(Label label) {
  switch (label) {
    case Label::Unmarked:
    case Label::Occluded:
      return kUnseen;
    case Label::OcclusionPlane:
      return kOcclusionPlane;
    case Label::Empty:
      return 1;
    case Label::Occupied:
      return kOccupied;
  }
  throw std::logic_error("a label that does not exist");
}

FreeSpaceField::FreeSpaceField(const MapWindow& window, std::uint8_t everywhere, int threads)
    : window_(window), cells_(window.size + VoxelIndex::Constant(2)), threads_(threads) {
  cells_[0] = round_up(cells_[0]);
  int bits = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    shift_[axis] = bits;
    bits += std::bit_width(static_cast<unsigned>(cells_[static_cast<int>(axis)] - 1));
  }
  if (bits > 30) {
    throw std::invalid_argument("the map's window is too large to plan in: choose larger voxels");
  }
  bytes_ = filled_with(everywhere);
}

FreeSpaceField FreeSpaceField::all_empty(const MapWindow& window, int threads) {
  return {window, byte_of(Label::Empty), threads};
}

FreeSpaceField::FreeSpaceField(const VoxelMap& map, int threads)
    : FreeSpaceField(map.window(), kUnseen, threads) {
  Box empty{cells_, VoxelIndex::Zero()};
  map.for_each_marked([&](std::size_t slot, Label label) {
    const VoxelIndex index = map.index_of_slot(slot);
    bytes_[offset(index)] = byte_of(label);
    if (label == Label::Empty) empty.add(index - window_.min + VoxelIndex::Ones());
  });
  if ((empty.min.array() >= empty.end.array()).any()) return;
#pragma omp parallel num_threads(threads_) if (threads_ > 1)
  find_distances(empty);
}

LazyArray<std::uint8_t> FreeSpaceField::filled_with(std::uint8_t everywhere) const {
  const auto layer_bytes = std::size_t{1} << shift_[2];
  std::vector<std::byte> layer(layer_bytes, std::byte{kOutside});
  for (int y = 0; y < window_.size[1]; ++y) {
    const std::size_t begin = (static_cast<std::size_t>(y + 1) << shift_[1]) + 1;
    std::fill_n(layer.begin() + static_cast<std::ptrdiff_t>(begin), window_.size[0],
                std::byte{everywhere});
  }
  const std::vector<std::byte> outside(1, std::byte{kOutside});
  const LazyPages::Stretch stretches[] = {
      {outside, layer_bytes},
      {std::move(layer), static_cast<std::size_t>(window_.size[2]) << shift_[2]},
      {outside, layer_bytes + 3}};
  return LazyArray<std::uint8_t>(stretches);
}

void FreeSpaceField::update(const VoxelMap& map, std::span<const std::uint32_t> changed_slots) {
  if (map.window().size != window_.size) {
    *this = FreeSpaceField(map, threads_);
    return;
  }
  Box changed{cells_, VoxelIndex::Zero()};
  if (map.window() != window_) move(map, changed);
#pragma omp parallel num_threads(threads_) if (threads_ > 1)
  {
    take_labels(map, changed_slots, changed);
    if ((changed.min.array() < changed.end.array()).all()) find_distances(changed);
  }
}

void FreeSpaceField::move(const VoxelMap& map, Box& changed) {
  FreeSpaceField before = std::move(*this);
  distance_ = std::move(before.distance_);
  window_ = map.window();
  bytes_ = LazyArray<Byte>(before.bytes_.size(), Byte{kOutside});
  const MapWindow kept = overlap(before.window_, window_);
  const auto row_of = [](auto& field, const VoxelIndex& voxel) {
    return field.bytes_.begin() + static_cast<std::ptrdiff_t>(field.offset(voxel));
  };
  for_each_row(kept, [&](const VoxelIndex& first) {
    std::copy_n(row_of(before, first), kept.size[0], row_of(*this, first));
  });
  const auto cell_of = [this](const VoxelIndex& voxel) {
    return VoxelIndex(voxel - window_.min + VoxelIndex::Ones());
  };
  for (const MapWindow& entered : left_behind(window_, before.window_.min)) {
    for_each_voxel(entered, [&](const VoxelIndex& voxel) {
      const Label label = map.label(voxel);
      bytes_[offset(voxel)] = byte_of(label);
      if (label == Label::Empty) changed.add(cell_of(voxel));
    });
  }
  // Of what was left only the layer around the window is still asked for, and it is no longer free.
  const MapWindow all = {window_.min - VoxelIndex::Ones(), window_.size + VoxelIndex::Constant(2)};
  for (const MapWindow& left : left_behind(before.window_, window_.min)) {
    for_each_voxel(overlap(left, all), [&](const VoxelIndex& voxel) {
      if (before.free_distance(voxel) > 0) changed.add(cell_of(voxel));
    });
  }
}

void FreeSpaceField::take_labels(const VoxelMap& map, std::span<const std::uint32_t> changed_slots,
                                 Box& changed) {
  Box mine{cells_, VoxelIndex::Zero()};
  const auto labels = map.labels();
#pragma omp for schedule(static) nowait
  for (std::size_t i = 0; i < changed_slots.size(); ++i) {
    const std::uint32_t slot = changed_slots[i];
    const VoxelIndex index = map.index_of_slot(slot);
    std::uint8_t& byte = bytes_[offset(index)];
    const Label label = labels[slot];
    const bool was_empty = byte <= kMaxJump;
    const bool is_empty = label == Label::Empty;
    byte = byte_of(label);
    if (was_empty != is_empty) mine.add(index - window_.min + VoxelIndex::Ones());
  }
#pragma omp critical
  {
    changed.min = changed.min.cwiseMin(mine.min);
    changed.end = changed.end.cwiseMax(mine.end);
  }
#pragma omp barrier
}

void FreeSpaceField::find_distances(const Box& changed) {
  // A distance depends on cells up to kMaxJump away, so `fresh` is where distances may be different
  // and `seen` what they depend on.
  const auto grown = [this](const Box& box) {
    Box result{(box.min - VoxelIndex::Constant(kMaxJump - 1)).cwiseMax(0),
               (box.end + VoxelIndex::Constant(kMaxJump - 1)).cwiseMin(cells_)};
    result.min[0] = round_down(result.min[0]);
    result.end[0] = round_up(result.end[0]);
    return result;
  };
  const Box fresh = grown(changed);
  const Box seen = grown(fresh);

  const auto length = static_cast<std::size_t>(fresh.end[0] - fresh.min[0]);
#pragma omp single
  distance_.resize(seen.end - seen.min, threads_);
#pragma omp for schedule(static)
  for (int z = seen.min[2]; z < seen.end[2]; ++z) {
    for (int y = seen.min[1]; y < seen.end[1]; ++y) {
      distance_.fill_row(y - seen.min[1], z - seen.min[2], row(y, z) + seen.min[0], kMaxJump);
    }
  }
  distance_.find();
#pragma omp for schedule(static)
  for (int z = fresh.min[2]; z < fresh.end[2]; ++z) {
    for (int y = fresh.min[1]; y < fresh.end[1]; ++y) {
      const Byte* const distances = distance_.row(y - seen.min[1], z - seen.min[2]);
      take_distances(distances + (fresh.min[0] - seen.min[0]), row(y, z) + fresh.min[0], length);
    }
  }
}

}  // namespace nextview
