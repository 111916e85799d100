#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace nextview {

/// Rays that drive along the same axis in the same direction. Their lines are those of IntegerLine
/// without a start, so one bundle serves every sensor position.
///
/// Rays stand in packets of kPacketRays, in columns of a cache line each; all rays of a packet are
/// counted for the same group, for instance a view. Neighbouring packets should point in about the
/// same direction, so that what one has read of the field is still near when the next comes.
struct RayBundle {
  static constexpr std::size_t kPacketRays = 16;  ///< a multiple of the rays any vector holds

  using Column = std::array<std::int32_t, kPacketRays>;
  struct alignas(64) Packet {
    Column slope1;  ///< IntegerLine::slope[(driving_axis + 1) % 3]
    Column slope2;  ///< and [(driving_axis + 2) % 3]
    Column reach;   ///< steps until the sensor's range limit; -1: not a ray
  };

  int driving_axis = 0;
  int direction = 1;  ///< +1 or -1 along it
  std::vector<Packet> packets;
  std::vector<std::int32_t> group;  ///< of each packet

  std::size_t rays() const { return packets.size() * kPacketRays; }
};

/// The packets of a bundle that nobody has cast yet. Threads that cast the same bundle take
/// portions from one queue, so that none waits for another that was given more.
class alignas(64) PacketQueue {  // a cache line of its own: it is written to by all threads
 public:
  struct Portion {
    std::size_t begin = 0;
    std::size_t end = 0;
  };

  /// Everything is to be cast (again), so many packets at a time.
  void refill(std::size_t packets, std::size_t portion) {
    packets_ = packets;
    portion_ = portion;
    next_.store(0, std::memory_order_relaxed);
  }
  /// Whether nothing is left. Costs less than taking an empty portion: no other thread is
  /// disturbed.
  bool empty() const { return next_.load(std::memory_order_relaxed) >= packets_; }
  /// The next portion; an empty one when nothing is left.
  Portion take() {
    const std::size_t begin = std::min(next_.fetch_add(portion_), packets_);
    return {begin, std::min(begin + portion_, packets_)};
  }

 private:
  std::atomic<std::size_t> next_{0};
  std::size_t packets_ = 0;
  std::size_t portion_ = 1;
};

/// How many rays met what.
struct RayCounts {
  std::int32_t occupied = 0;
  std::int32_t occlusion_plane = 0;
  std::int32_t unseen = 0;
};

/// Where to write what rays met; what is null is not asked for. Sets of bits hold ray i of the
/// bundle in bit i % 8 of byte i / 8.
struct RayOutcomes {
  RayCounts* counts = nullptr;          ///< by group; added to
  std::int32_t* occupied_at = nullptr;  ///< by ray: offset of the Occupied voxel met, or -1
  std::int32_t* met_at = nullptr;       ///< by ray: offset of the voxel met, or -1 when none was
  std::uint8_t* occupied = nullptr;     ///< bits that are set where a ray met an Occupied voxel;
  std::uint8_t* occlusion_plane = nullptr;  ///< to be clear beforehand, and all three be there
  std::uint8_t* unseen = nullptr;
};

/// Walks the rays of a bundle, as far as the queue has any, through a FreeSpaceField.
///
///     byte:  . . 3 2 2 2 3 . .        A ray at k reads its voxel's byte. If that is a jump of d,
///            . 3 2 1 1 1 2 3 .        everything nearer than d is Empty and k advances by d;
///     k ->---*-------*---*-*X         otherwise the ray has ended and k stays. k is all there is:
///            . 3 2 1 1 1 2 3 .        offset(k) = start + k s0 + ((k a + 1/2) >> 16) << shift1
///                                                              + ((k b + 1/2) >> 16) << shift2
///
/// Eight rays (AVX2) advance together in one vector. Eight vectors take turns, so that the
/// processor always has gathers under way while it works out where the next ones go; a vector whose
/// rays have all ended makes room for the next of the table at once, while the others go on.
///
/// @param field    FreeSpaceField::bytes()
/// @param shifts   FreeSpaceField::shifts()
/// @param start    offset of the sensor's voxel
/// @param first_k  a step up to which all rays are known to meet only Empty, at least 1
void cast_bundle(const std::uint8_t* field, const std::array<int, 3>& shifts, std::int32_t start,
                 std::int32_t first_k, const RayBundle& bundle, PacketQueue& packets,
                 const RayOutcomes& outcomes);

/// The instruction set cast_bundle uses on this processor, e.g. "AVX2".
const char* ray_kernel_target();

}  // namespace nextview
