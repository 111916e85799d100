#include "planner/prediction/known_space.h"

#include <stdexcept>
#include <vector>

namespace nextview {

KnownSpace::KnownSpace(const VoxelMap& map, Surfaces surfaces, int threads)
    : map_(map), surfaces_kept_(surfaces), field_(map, threads) {
  if (!keeps_surfaces()) return;
  std::vector<std::uint32_t> occupied;
  map.for_each_marked([&](std::size_t slot, Label label) {
    if (label == Label::Occupied) occupied.push_back(static_cast<std::uint32_t>(slot));
  });
  surfaces_.update(map, field_, occupied);
}

void KnownSpace::update(std::span<const std::uint32_t> changed_slots,
                        std::span<const std::uint32_t> updated_surfaces) {
  const VoxelIndex step = map_.window().min - field_.window().min;
  field_.update(map_, changed_slots);
  if (!keeps_surfaces()) return;
  if (!step.isZero()) surfaces_.move(field_, step);
  // A voxel may become Occupied by points that had no normal, and so without surface data.
  surfaces_.update(map_, field_, changed_slots);
  surfaces_.update(map_, field_, updated_surfaces);
}

const SurfaceTable& KnownSpace::surfaces() const {
  if (!keeps_surfaces()) {
    throw std::logic_error("surfaces are to be counted in a space that keeps none");
  }
  return surfaces_;
}

}  // namespace nextview
