#include "mapper/ray_marking.h"

#include "mapper/integer_line.h"
#include "mapper/map_census.h"

namespace nextview {

namespace {

// IntegerLine::at in slots of the map: one fixed-point number per axis. Only the bits that the
// axis' mask keeps matter, so the numbers may wrap.
class SlotWalk {
 public:
  SlotWalk(const VoxelMap& map, const IntegerLine& line, int k) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto start = static_cast<std::uint32_t>(line.start[static_cast<int>(axis)])
                         << IntegerLine::kFractionBits;
      slope_[axis] = static_cast<std::uint32_t>(line.slope[axis]);
      position_[axis] = start + static_cast<std::uint32_t>(IntegerLine::kHalf) +
                        static_cast<std::uint32_t>(k) * slope_[axis];
      mask_[axis] = static_cast<std::uint32_t>(map.sides()[axis] - 1);
      shift_[axis] = map.shifts()[axis];
    }
  }
  std::uint32_t slot() const { return part(0) | part(1) | part(2); }
  void step() {
    for (std::size_t axis = 0; axis < 3; ++axis) position_[axis] += slope_[axis];
  }

 private:
  std::uint32_t part(std::size_t axis) const {
    return (position_[axis] >> IntegerLine::kFractionBits & mask_[axis]) << shift_[axis];
  }

  std::uint32_t position_[3];
  std::uint32_t slope_[3];
  std::uint32_t mask_[3];
  int shift_[3];
};

// Raises the voxels k = first ... last of a line that are below a label to a new one.
void raise(VoxelMap& map, const IntegerLine& line, int first, int last, Label below, Label to,
           std::vector<std::uint32_t>& changed_slots) {
  if (last < first) return;
  Label* const labels = map.labels().data();
  const std::size_t before = changed_slots.size();
  changed_slots.resize(before + static_cast<std::size_t>(last - first + 1));
  std::uint32_t* changed = changed_slots.data() + before;
  SlotWalk walk(map, line, first);
  for (int k = first; k <= last; ++k) {
    const std::uint32_t slot = walk.slot();
    const Label label = labels[slot];
    const bool raised = label < below;
    labels[slot] = raised ? to : label;
    *changed = slot;
    changed += raised;
    walk.step();
  }
  changed_slots.resize(static_cast<std::size_t>(changed - changed_slots.data()));
}

struct EndLine {
  IntegerLine line;
  int inside;  ///< steps_inside
  bool is_surface;
};

}  // namespace

std::int64_t mark_rays(VoxelMap& map, const VoxelIndex& sensor, std::span<const RayEnd> ends,
                       std::vector<std::uint32_t>& changed_slots) {
  const std::size_t before = changed_slots.size();
  std::vector<EndLine> lines;
  lines.reserve(ends.size());
  for (const RayEnd& end : ends) {
    const IntegerLine line = line_between(sensor, end.voxel);
    lines.push_back({line, steps_inside(line, map.window()), end.is_surface});
  }

  for (const EndLine& end : lines) {
    if (!end.is_surface) continue;
    raise(map, end.line, end.line.steps, end.line.steps, Label::Occupied, Label::Occupied,
          changed_slots);
  }
  const auto newly_occupied = static_cast<std::int64_t>(changed_slots.size() - before);

  for (const EndLine& end : lines) {
    const int last_free =
        end.is_surface ? end.line.steps - 1 : std::min(end.line.steps, end.inside);
    raise(map, end.line, 0, last_free, Label::Empty, Label::Empty, changed_slots);
  }
  for (const EndLine& end : lines) {
    // A line without steps has no direction to be carried on in.
    if (!end.is_surface || end.line.steps == 0) continue;
    raise(map, end.line, end.line.steps + 1, end.inside, Label::Occluded, kFreshlyOccluded,
          changed_slots);
  }
  return newly_occupied;
}

}  // namespace nextview
