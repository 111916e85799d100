#include "planner/prediction/ray_kernel.h"

#include "planner/prediction/free_space_field.h"

// Highway compiles the rest of this file once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "planner/prediction/ray_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace nextview::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<std::int32_t, RayBundle::kPacketRays>;
using Vector = hn::Vec<Tag>;

constexpr std::size_t kInFlight = 8;  // vectors that take turns

// What all rays of a bundle share.
struct Walk {
  const std::int32_t* field;
  Vector start;
  Vector driving_shift;
  Vector shift1;
  Vector shift2;
};

// The rays of one vector.
struct Rays {
  std::size_t first;  // its place in the table
  Vector slope1;
  Vector slope2;
  Vector k;
  Vector read;  // of the field: a byte and three that do not matter
};

// Part of a packet's column, from a ray of the bundle on.
HWY_INLINE Vector part_of(const RayBundle::Column& column, std::size_t first) {
  return hn::Load(Tag(), &column[first % RayBundle::kPacketRays]);
}

HWY_INLINE Rays load(const RayBundle& bundle, std::size_t first, Vector first_k) {
  const RayBundle::Packet& packet = bundle.packets[first / RayBundle::kPacketRays];
  return {first, part_of(packet.slope1, first), part_of(packet.slope2, first), first_k,
          hn::Zero(Tag())};
}

// SSE has no shifts by lane; elsewhere they cost less than a shift of all lanes by a register.
HWY_INLINE Vector shift_left(Vector v, Vector bits) {
#if HWY_TARGET == HWY_SSE4 || HWY_TARGET == HWY_SSSE3
  return hn::ShiftLeftSame(v, hn::GetLane(bits));
#else
  return hn::Shl(v, bits);
#endif
}

HWY_INLINE Vector fixed_point(Vector k, Vector slope, Vector shift) {
  const Tag d;
  const Vector half = hn::Set(d, 1 << 15);
  return shift_left(hn::ShiftRight<16>(hn::Add(hn::Mul(k, slope), half)), shift);
}

// Where in the field rays are.
template <int direction>
HWY_INLINE Vector offset_of(const Walk& walk, const Rays& rays) {
  const Vector along = shift_left(rays.k, walk.driving_shift);
  const Vector across = hn::Add(fixed_point(rays.k, rays.slope1, walk.shift1),
                                fixed_point(rays.k, rays.slope2, walk.shift2));
  return hn::Add(direction > 0 ? hn::Add(walk.start, along) : hn::Sub(walk.start, along), across);
}

// Reads each ray's byte and jumps. Returns whether any did.
template <int direction>
HWY_INLINE bool advance(const Walk& walk, Rays& rays) {
  const Tag d;
  rays.read = hn::GatherOffset(d, walk.field, offset_of<direction>(walk, rays));
  const Vector jump = hn::And(rays.read, hn::Set(d, FreeSpaceField::kMaxJump));
  rays.k = hn::Add(rays.k, jump);
  return !hn::AllTrue(d, hn::Eq(jump, hn::Zero(d)));
}

// Sets the bits of rays from `first` on. Vectors of less than eight rays share a byte.
template <class Mask>
HWY_INLINE void store_bits(Mask mask, std::size_t first, std::uint8_t* bits) {
  const Tag d;
  std::uint8_t set[8] = {};
  const std::size_t bytes = hn::StoreMaskBits(d, mask, set);
  for (std::size_t i = 0; i < bytes; ++i) {
    bits[first / 8 + i] =
        static_cast<std::uint8_t>(bits[first / 8 + i] | static_cast<unsigned>(set[i]) << first % 8);
  }
}

// Says where the rays of a vector have ended.
template <int direction>
HWY_INLINE void finish(const RayBundle& bundle, const Walk& walk, const Rays& rays,
                       const RayOutcomes& outcomes) {
  const Tag d;
  const std::size_t packet = rays.first / RayBundle::kPacketRays;
  const auto too_far = hn::Gt(rays.k, part_of(bundle.packets[packet].reach, rays.first));
  const Vector kind = hn::IfThenElse(too_far, hn::Set(d, FreeSpaceField::kOutside),
                                     hn::And(rays.read, hn::Set(d, 255)));
  const auto occupied = hn::Eq(kind, hn::Set(d, FreeSpaceField::kOccupied));
  const auto plane = hn::Eq(kind, hn::Set(d, FreeSpaceField::kOcclusionPlane));
  const auto unseen = hn::Eq(kind, hn::Set(d, FreeSpaceField::kUnseen));
  if (outcomes.counts != nullptr) {
    RayCounts& counts = outcomes.counts[bundle.group[packet]];
    counts.occupied += static_cast<std::int32_t>(hn::CountTrue(d, occupied));
    counts.occlusion_plane += static_cast<std::int32_t>(hn::CountTrue(d, plane));
    counts.unseen += static_cast<std::int32_t>(hn::CountTrue(d, unseen));
  }
  if (outcomes.occupied_at != nullptr) {
    hn::StoreU(hn::IfThenElse(occupied, offset_of<direction>(walk, rays), hn::Set(d, -1)), d,
               outcomes.occupied_at + rays.first);
  }
  if (outcomes.met_at != nullptr) {
    const auto met = hn::Ne(kind, hn::Set(d, FreeSpaceField::kOutside));
    hn::StoreU(hn::IfThenElse(met, offset_of<direction>(walk, rays), hn::Set(d, -1)), d,
               outcomes.met_at + rays.first);
  }
  if (outcomes.occupied != nullptr) {
    store_bits(occupied, rays.first, outcomes.occupied);
    store_bits(plane, rays.first, outcomes.occlusion_plane);
    store_bits(unseen, rays.first, outcomes.unseen);
  }
}

// The vectors of rays still to be cast, one after the other.
class Supply {
 public:
  explicit Supply(PacketQueue& packets) : packets_(packets) { take(); }

  // Whether there is a next one.
  HWY_INLINE bool any() {
    if (next_ == end_) take();
    return next_ != end_;
  }
  HWY_INLINE Rays next(const RayBundle& bundle, Vector first_k) {
    const std::size_t first = next_;
    next_ += hn::Lanes(Tag());
    return load(bundle, first, first_k);
  }

 private:
  void take() {
    const PacketQueue::Portion portion = packets_.take();
    next_ = portion.begin * RayBundle::kPacketRays;
    end_ = portion.end * RayBundle::kPacketRays;
  }

  PacketQueue& packets_;
  std::size_t next_ = 0;
  std::size_t end_ = 0;
};

template <int direction>
HWY_INLINE void cast(const RayBundle& bundle, const Walk& walk, Vector first_k, Supply supply,
                     const RayOutcomes& outcomes) {
  Rays turns[kInFlight];
  std::size_t taken = 0;
  for (; taken < kInFlight && supply.any(); ++taken) turns[taken] = supply.next(bundle, first_k);
  bool all_taken = taken == kInFlight;
  while (all_taken) {
    bool moving[kInFlight];
    HWY_UNROLL(8)
    for (std::size_t i = 0; i < kInFlight; ++i) moving[i] = advance<direction>(walk, turns[i]);
    HWY_UNROLL(8)
    for (std::size_t i = 0; i < kInFlight; ++i) {
      if (HWY_LIKELY(moving[i])) continue;
      all_taken = supply.any();
      if (!all_taken) break;
      finish<direction>(bundle, walk, turns[i], outcomes);
      turns[i] = supply.next(bundle, first_k);
    }
  }
  bool any_moves = true;
  while (any_moves) {
    any_moves = false;
    for (std::size_t i = 0; i < taken; ++i) any_moves |= advance<direction>(walk, turns[i]);
  }
  for (std::size_t i = 0; i < taken; ++i) finish<direction>(bundle, walk, turns[i], outcomes);
}

void CastBundle(const std::uint8_t* field, const std::array<int, 3>& shifts, std::int32_t start,
                std::int32_t first_k, const RayBundle& bundle, PacketQueue& packets,
                const RayOutcomes& outcomes) {
  const Tag d;
  const auto axis = static_cast<std::size_t>(bundle.driving_axis);
  const Walk walk{reinterpret_cast<const std::int32_t*>(field), hn::Set(d, start),
                  hn::Set(d, shifts[axis]), hn::Set(d, shifts[(axis + 1) % 3]),
                  hn::Set(d, shifts[(axis + 2) % 3])};
  const Vector k = hn::Set(d, first_k);
  if (bundle.direction > 0) {
    cast<+1>(bundle, walk, k, Supply(packets), outcomes);
  } else {
    cast<-1>(bundle, walk, k, Supply(packets), outcomes);
  }
}

const char* TargetName() { return hwy::TargetName(HWY_TARGET); }

}  // namespace nextview::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nextview {

HWY_EXPORT(CastBundle);
HWY_EXPORT(TargetName);

void cast_bundle(const std::uint8_t* field, const std::array<int, 3>& shifts, std::int32_t start,
                 std::int32_t first_k, const RayBundle& bundle, PacketQueue& packets,
                 const RayOutcomes& outcomes) {
  HWY_DYNAMIC_DISPATCH(CastBundle)(field, shifts, start, first_k, bundle, packets, outcomes);
}

const char* ray_kernel_target() { return HWY_DYNAMIC_DISPATCH(TargetName)(); }

}  // namespace nextview
#endif
