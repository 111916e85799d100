#include "mapper/ray_marking.h"

#include <algorithm>

#include "mapper/integer_line.h"
#include "mapper/line_bundle.h"

namespace nextview {

namespace {

// Raises labels, and remembers what has changed.
class Marker {
 public:
  Marker(VoxelMap& map, std::vector<std::uint32_t>& changed_slots)
      : map_(map), bundle_(map), changed_slots_(changed_slots) {}

  // Raises the voxels k = first ... last of a line that are below a label to a new one, now or when
  // finish() is called. They must lie inside the window.
  void raise(const IntegerLine& line, int first, int last, Label below, Label to) {
    if (last < first) return;
    bundle_.add(line, first, last);
    if (bundle_.full()) finish(below, to);
  }

  void finish(Label below, Label to) {
    Label* const labels = map_.labels().data();
    const auto [slots, size] = bundle_.take_slots(map_, below);
    std::size_t count = 0;
    // What repeats is below the label no more when it comes again.
    for (std::size_t n = 0; n < size; ++n) {
      const std::uint32_t slot = slots[n];
      const auto label = static_cast<std::uint32_t>(labels[slot]);
      // In integers, so that no compiler makes a branch of it: no processor could foresee it.
      const std::uint32_t raised = label < static_cast<std::uint32_t>(below);
      labels[slot] = static_cast<Label>(label + (static_cast<std::uint32_t>(to) - label) * raised);
      slots[count] = slot;  // overwritten by the next one unless this counts
      count += raised;
    }
    changed_slots_.insert(changed_slots_.end(), slots, slots + count);
  }

 private:
  VoxelMap& map_;
  LineBundle bundle_;
  std::vector<std::uint32_t>& changed_slots_;
};

struct EndLine {
  IntegerLine line;
  int inside;  ///< steps_inside
  bool is_surface;
};

}  // namespace

std::int64_t mark_rays(VoxelMap& map, const VoxelIndex& sensor, std::span<const RayEnd> ends,
                       std::span<const Shadow> shadows, std::vector<std::uint32_t>& changed_slots) {
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
  marker.finish(Label::Occupied, Label::Occupied);
  const auto newly_occupied = static_cast<std::int64_t>(changed_slots.size() - before);

  for (const EndLine& end : lines) {
    const int last_free =
        end.is_surface ? end.line.steps - 1 : std::min(end.line.steps, end.inside);
    marker.raise(end.line, 0, last_free, Label::Empty, Label::Empty);
  }
  marker.finish(Label::Empty, Label::Empty);
  for (const Shadow& shadow : shadows) {
    const IntegerLine line = line_between(ends[shadow.end].voxel, shadow.limit);
    marker.raise(line, 1, line.steps, Label::Occluded, Label::Occluded);
  }
  marker.finish(Label::Occluded, Label::Occluded);
  return newly_occupied;
}

}  // namespace nextview
