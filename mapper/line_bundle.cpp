#include "mapper/line_bundle.h"

#include <algorithm>

// Highway compiles the rest of this file once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mapper/line_bundle.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "mapper/store_kept-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nextview::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<std::int32_t, LineBundle::kLines>;
using Vector = hn::Vec<Tag>;

// The stretches in the lanes of one vector.
struct Lanes {
  Vector position[3];
  Vector slope[3];
  Vector voxels;
};

HWY_INLINE Lanes load(const LineBundle::Stretches& stretches, std::size_t i) {
  const Tag d;
  Lanes lanes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lanes.position[axis] = hn::Load(d, &stretches.position[axis][i]);
    lanes.slope[axis] = hn::Load(d, &stretches.slope[axis][i]);
  }
  lanes.voxels = hn::Load(d, &stretches.voxels[i]);
  return lanes;
}

HWY_INLINE Vector slot_of(const LineBundle::Layout& layout, const Lanes& lanes) {
  const Tag d;
  const auto part = [&](std::size_t axis) HWY_ATTR {
    const Vector index = hn::ShiftRight<IntegerLine::kFractionBits>(lanes.position[axis]);
    return hn::ShiftLeftSame(hn::And(index, hn::Set(d, layout.mask[axis])), layout.shift[axis]);
  };
  return hn::Or(hn::Or(part(0), part(1)), part(2));
}

// The labels as words that begin at each slot, and which labels count.
struct Below {
  const std::int32_t* labels;
  std::int32_t label;
};

// One step of a vector of lines; returns where the next slots go.
HWY_INLINE std::int32_t* step(const LineBundle::Layout& layout, const Below& below, std::int32_t k,
                              Lanes& lanes, std::int32_t* to) {
  const Tag d;
  const Vector none = hn::Set(d, -1);
  const auto walking = hn::Gt(lanes.voxels, hn::Set(d, k));
  const Vector slot = hn::IfThenElse(walking, slot_of(layout, lanes), none);
  // The lane before; the first lane looks at itself, and is to differ.
  const Vector before = hn::Max(hn::Sub(hn::Iota(d, 0), hn::Set(d, 1)), hn::Zero(d));
  const Vector neighbour = hn::IfThenElse(
      hn::FirstN(d, 1), none, hn::TableLookupLanes(slot, hn::IndicesFromVec(d, before)));
  const auto repeats = hn::Or(hn::Eq(slot, neighbour), hn::Eq(slot, none));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lanes.position[axis] = hn::Add(lanes.position[axis], lanes.slope[axis]);
  }
  const Vector words = hn::GatherOffset(d, below.labels, hn::IfThenZeroElse(repeats, slot));
  const auto counts = hn::Lt(hn::And(words, hn::Set(d, 0xff)), hn::Set(d, below.label));
  const auto kept = hn::AndNot(repeats, counts);
  return to + store_kept(d, slot, kept, to);
}

std::size_t WalkBundle(const LineBundle::Layout& layout, const LineBundle::Stretches& stretches,
                       std::int32_t longest, const std::uint8_t* labels, std::int32_t below_label,
                       std::uint32_t* slots) {
  const Below below{reinterpret_cast<const std::int32_t*>(labels), below_label};
  const Tag d;
  constexpr std::size_t kVectors = LineBundle::kLines / hn::MaxLanes(Tag());
  Lanes lanes[kVectors];
  for (std::size_t n = 0; n < kVectors; ++n) lanes[n] = load(stretches, n * hn::Lanes(d));
  std::int32_t* const begin = reinterpret_cast<std::int32_t*>(slots);
  std::int32_t* to = begin;
  for (std::int32_t k = 0; k < longest; ++k) {
    for (Lanes& some : lanes) to = step(layout, below, k, some, to);
  }
  return static_cast<std::size_t>(to - begin);
}

}  // namespace
}  // namespace nextview::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nextview {

namespace {
HWY_EXPORT(WalkBundle);
}  // namespace

LineBundle::LineBundle(const VoxelMap& map) : layout_{{}, map.shifts()} {
  for (std::size_t axis = 0; axis < 3; ++axis) layout_.mask[axis] = map.sides()[axis] - 1;
}

void LineBundle::add(const IntegerLine& line, int first, int last) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t start = line.start[static_cast<int>(axis)];
    const std::int64_t position = start * (std::int64_t{1} << IntegerLine::kFractionBits) +
                                  IntegerLine::kHalf + std::int64_t{first} * line.slope[axis];
    stretches_.position[axis][size_] = static_cast<std::int32_t>(position);
    stretches_.slope[axis][size_] = line.slope[axis];
  }
  stretches_.voxels[size_] = last - first + 1;
  longest_ = std::max(longest_, stretches_.voxels[size_]);
  ++size_;
}

LineBundle::Slots LineBundle::take_slots(const VoxelMap& map, Label below) {
  // A vector's worth of room beyond the end for those who store whole vectors.
  const std::size_t room = (static_cast<std::size_t>(longest_) + 1) * kLines;
  if (slots_.size() < room) slots_.resize(room);
  std::fill(stretches_.voxels.begin() + static_cast<std::ptrdiff_t>(size_), stretches_.voxels.end(),
            0);
  const std::size_t size = HWY_DYNAMIC_DISPATCH(WalkBundle)(
      layout_, stretches_, longest_, reinterpret_cast<const std::uint8_t*>(map.labels().data()),
      static_cast<std::int32_t>(below), slots_.data());
  size_ = 0;
  longest_ = 0;
  return {slots_.data(), size};
}

}  // namespace nextview
#endif
