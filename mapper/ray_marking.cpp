#include "mapper/ray_marking.h"

#include <algorithm>

#include "mapper/integer_line.h"
#include "mapper/map_census.h"

namespace nextview {

namespace {

// IntegerLine::at in slots of the map: per axis the fixed-point position, shifted to where the
// axis' bits of a slot are. Masked and shifted back, the three together are the slot; bits above
// and below an axis' own do not matter, so the numbers may wrap.
class SlotWalk {
 public:
  SlotWalk(const VoxelMap& map, const IntegerLine& line, int k) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int64_t start = line.start[static_cast<int>(axis)];
      const std::int64_t slope = line.slope[axis];
      const std::int64_t position =
          start * (std::int64_t{1} << IntegerLine::kFractionBits) + IntegerLine::kHalf + k * slope;
      const int shift = map.shifts()[axis];
      position_[axis] = static_cast<std::uint64_t>(position) << shift;
      slope_[axis] = static_cast<std::uint64_t>(slope) << shift;
      mask_[axis] = static_cast<std::uint64_t>(map.sides()[axis] - 1)
                    << (shift + IntegerLine::kFractionBits);
    }
  }
  std::uint32_t slot() const {
    const std::uint64_t bits =
        (position_[0] & mask_[0]) | (position_[1] & mask_[1]) | (position_[2] & mask_[2]);
    return static_cast<std::uint32_t>(bits >> IntegerLine::kFractionBits);
  }
  void step() {
    for (std::size_t axis = 0; axis < 3; ++axis) position_[axis] += slope_[axis];
  }

 private:
  std::uint64_t position_[3];
  std::uint64_t slope_[3];
  std::uint64_t mask_[3];
};

// Raises labels along lines, and remembers what has changed.
class Marker {
 public:
  Marker(VoxelMap& map, std::vector<std::uint32_t>& changed_slots)
      : map_(map), changed_slots_(changed_slots) {
    line_changes_.resize(static_cast<std::size_t>(map.window().size.maxCoeff()) + 1);
  }

  // Raises the voxels k = first ... last of a line that are below a label to a new one. They must
  // lie inside the window.
  void raise(const IntegerLine& line, int first, int last, Label below, Label to) {
    Label* const labels = map_.labels().data();
    std::uint32_t* const changes = line_changes_.data();
    std::size_t count = 0;
    SlotWalk walk(map_, line, first);
    for (int k = first; k <= last; ++k) {
      const std::uint32_t slot = walk.slot();
      const Label label = labels[slot];
      const bool raised = label < below;
      labels[slot] = raised ? to : label;
      changes[count] = slot;  // overwritten by the next one unless this counts
      count += raised;
      walk.step();
    }
    changed_slots_.insert(changed_slots_.end(), changes, changes + count);
  }

 private:
  VoxelMap& map_;
  std::vector<std::uint32_t>& changed_slots_;
  std::vector<std::uint32_t> line_changes_;
};

struct EndLine {
  IntegerLine line;
  int inside;  ///< steps_inside
  bool is_surface;
};

}  // namespace

std::int64_t mark_rays(VoxelMap& map, const VoxelIndex& sensor, std::span<const RayEnd> ends,
                       std::vector<std::uint32_t>& changed_slots) {
  const std::size_t before = changed_slots.size();
  Marker marker(map, changed_slots);
  std::vector<EndLine> lines;
  lines.reserve(ends.size());
  for (const RayEnd& end : ends) {
    const IntegerLine line = line_between(sensor, end.voxel);
    lines.push_back({line, steps_inside(line, map.window()), end.is_surface});
  }

  for (const EndLine& end : lines) {
    if (!end.is_surface) continue;
    marker.raise(end.line, end.line.steps, end.line.steps, Label::Occupied, Label::Occupied);
  }
  const auto newly_occupied = static_cast<std::int64_t>(changed_slots.size() - before);

  for (const EndLine& end : lines) {
    const int last_free =
        end.is_surface ? end.line.steps - 1 : std::min(end.line.steps, end.inside);
    marker.raise(end.line, 0, last_free, Label::Empty, Label::Empty);
  }
  for (const EndLine& end : lines) {
    // A line without steps has no direction to be carried on in.
    if (!end.is_surface || end.line.steps == 0) continue;
    marker.raise(end.line, end.line.steps + 1, end.inside, Label::Occluded, kFreshlyOccluded);
  }
  return newly_occupied;
}

}  // namespace nextview
