#include "planner/ray_kernel.h"

#include "planner/free_space_field.h"

// Highway compiles the rest of this file once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "planner/ray_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace nextview::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<std::int32_t, kBundleGranularity>;
using Vector = hn::Vec<Tag>;

// What all rays of a bundle share.
struct Walk {
  const std::int32_t* field;
  Vector start;
  Vector driving_stride;
  int shift1;
  int shift2;
};

// The rays of one vector.
struct Rays {
  Vector slope1;
  Vector slope2;
  Vector k;
  Vector offset;
  Vector byte;
};

HWY_INLINE Vector fixed_point(Vector k, Vector slope, int shift) {
  const Tag d;
  const Vector half = hn::Set(d, 1 << 15);
  return hn::ShiftLeftSame(hn::ShiftRight<16>(hn::Add(hn::Mul(k, slope), half)), shift);
}

// Reads each ray's byte and jumps; returns by how much.
HWY_INLINE Vector advance(const Walk& walk, Rays& rays) {
  const Tag d;
  const Vector jump = hn::Set(d, FreeSpaceField::kJump);
  const Vector across = hn::Add(fixed_point(rays.k, rays.slope1, walk.shift1),
                                fixed_point(rays.k, rays.slope2, walk.shift2));
  rays.offset = hn::Add(hn::Add(walk.start, hn::Mul(rays.k, walk.driving_stride)), across);
  rays.byte = hn::And(hn::GatherOffset(d, walk.field, rays.offset), hn::Set(d, 255));
  const Vector step = hn::Sub(hn::Max(rays.byte, jump), jump);
  rays.k = hn::Add(rays.k, step);
  return step;
}

HWY_INLINE Rays load(const RayBundle& bundle, std::size_t i, Vector first_k) {
  const Tag d;
  Rays rays;
  rays.slope1 = hn::LoadU(d, &bundle.slope1[i]);
  rays.slope2 = hn::LoadU(d, &bundle.slope2[i]);
  rays.k = first_k;
  rays.offset = hn::Zero(d);
  rays.byte = hn::Zero(d);
  return rays;
}

// Sums of what was met, one count a lane.
struct LaneCounts {
  Vector occupied;
  Vector occlusion_plane;
  Vector unseen;
};

// Sets the bits of the rays from i on; they must be clear where a byte is shared by vectors.
template <class Mask>
HWY_INLINE void store_bits(Mask mask, std::size_t i, std::uint8_t* bits) {
  const Tag d;
  if (hn::Lanes(d) >= 8) {
    hn::StoreMaskBits(d, mask, bits + i / 8);
    return;
  }
  std::uint8_t few[8] = {};
  hn::StoreMaskBits(d, mask, few);
  const auto kept = i % 8 == 0 ? 0U : bits[i / 8];
  bits[i / 8] = static_cast<std::uint8_t>(kept | static_cast<unsigned>(few[0]) << (i % 8));
}

HWY_INLINE void count(const RayBundle& bundle, std::size_t i, const Rays& rays, LaneCounts& counts,
                      const RayEnds& ends) {
  const Tag d;
  const auto too_far = hn::Gt(rays.k, hn::LoadU(d, &bundle.reach[i]));
  const Vector kind = hn::IfThenElse(too_far, hn::Set(d, FreeSpaceField::kOutside), rays.byte);
  const auto occupied = hn::Eq(kind, hn::Set(d, FreeSpaceField::kOccupied));
  const auto plane = hn::Eq(kind, hn::Set(d, FreeSpaceField::kOcclusionPlane));
  const auto unseen = hn::Eq(kind, hn::Set(d, FreeSpaceField::kUnseen));
  counts.occupied = hn::Sub(counts.occupied, hn::VecFromMask(d, occupied));
  counts.occlusion_plane = hn::Sub(counts.occlusion_plane, hn::VecFromMask(d, plane));
  counts.unseen = hn::Sub(counts.unseen, hn::VecFromMask(d, unseen));
  if (ends.occupied_at != nullptr) {
    hn::StoreU(hn::IfThenElse(occupied, rays.offset, hn::Set(d, -1)), d, ends.occupied_at + i);
  }
  if (ends.occupied != nullptr) {
    store_bits(occupied, i, ends.occupied);
    store_bits(plane, i, ends.occlusion_plane);
    store_bits(unseen, i, ends.unseen);
  }
}

RayCounts CastBundle(const std::uint8_t* field, const std::array<int, 3>& shifts,
                     std::int32_t start, std::int32_t first_k, const RayBundle& bundle,
                     const RayEnds& ends) {
  const Tag d;
  const std::size_t lanes = hn::Lanes(d);
  const auto axis = static_cast<std::size_t>(bundle.driving_axis);
  const Walk walk{reinterpret_cast<const std::int32_t*>(field), hn::Set(d, start),
                  hn::Set(d, bundle.direction * (1 << shifts[axis])), shifts[(axis + 1) % 3],
                  shifts[(axis + 2) % 3]};
  const Vector k = hn::Set(d, first_k);
  const auto moving = [&d](Vector steps)
                          HWY_ATTR { return !hn::AllTrue(d, hn::Eq(steps, hn::Zero(d))); };
  LaneCounts counts{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  const auto size = static_cast<std::size_t>(bundle.size());
  std::size_t i = 0;
  for (; i + 4 * lanes <= size; i += 4 * lanes) {
    Rays a = load(bundle, i, k);
    Rays b = load(bundle, i + lanes, k);
    Rays c = load(bundle, i + 2 * lanes, k);
    Rays e = load(bundle, i + 3 * lanes, k);
    while (moving(hn::Or(hn::Or(advance(walk, a), advance(walk, b)),
                         hn::Or(advance(walk, c), advance(walk, e))))) {
    }
    count(bundle, i, a, counts, ends);
    count(bundle, i + lanes, b, counts, ends);
    count(bundle, i + 2 * lanes, c, counts, ends);
    count(bundle, i + 3 * lanes, e, counts, ends);
  }
  for (; i < size; i += lanes) {
    Rays a = load(bundle, i, k);
    while (moving(advance(walk, a))) {
    }
    count(bundle, i, a, counts, ends);
  }
  const auto total = [&d](Vector v) HWY_ATTR { return hn::GetLane(hn::SumOfLanes(d, v)); };
  return {total(counts.occupied), total(counts.occlusion_plane), total(counts.unseen)};
}

const char* TargetName() { return hwy::TargetName(HWY_TARGET); }

}  // namespace nextview::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nextview {

HWY_EXPORT(CastBundle);
HWY_EXPORT(TargetName);

RayCounts cast_bundle(const std::uint8_t* field, const std::array<int, 3>& shifts,
                      std::int32_t start, std::int32_t first_k, const RayBundle& bundle,
                      const RayEnds& ends) {
  return HWY_DYNAMIC_DISPATCH(CastBundle)(field, shifts, start, first_k, bundle, ends);
}

const char* ray_kernel_target() { return HWY_DYNAMIC_DISPATCH(TargetName)(); }

}  // namespace nextview
#endif
