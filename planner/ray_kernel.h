#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace nextview {

/// Rays that drive along the same axis in the same direction, as columns of a table. Their lines
/// are those of IntegerLine without a start, so one table serves every sensor position.
struct RayBundle {
  int driving_axis = 0;
  int direction = 1;                 ///< +1 or -1 along it
  std::vector<std::int32_t> slope1;  ///< per ray, IntegerLine::slope[(driving_axis + 1) % 3]
  std::vector<std::int32_t> slope2;  ///< and [(driving_axis + 2) % 3]
  std::vector<std::int32_t> reach;   ///< steps until the sensor's range limit, per ray
  std::vector<std::int32_t> ray;     ///< whose ray it is: an index of the caller's
  int padding = 0;                   ///< rays at the end that are no rays: reach -1

  int size() const { return static_cast<int>(slope1.size()); }
};

/// A bundle's size must be a multiple of this: the most rays one vector holds.
constexpr int kBundleGranularity = 16;

/// Where to write, on request, what every single ray of a bundle met. A set of bits holds ray i in
/// bit i % 8 of byte i / 8, and must have room for the whole bundle.
struct RayEnds {
  std::int32_t* occupied_at = nullptr;  ///< offset of the Occupied voxel met, or -1
  std::uint8_t* occupied = nullptr;     ///< bits: met an Occupied voxel
  std::uint8_t* occlusion_plane = nullptr;
  std::uint8_t* unseen = nullptr;
};

/// How many rays met what.
struct RayCounts {
  int occupied = 0;
  int occlusion_plane = 0;
  int unseen = 0;
};

/// Walks every ray of a bundle through a FreeSpaceField.
///
///     byte:  . . 5 4 4 4 5 . .        A ray at k reads its voxel's byte. If that is a jump of d,
///            . 5 4 3 3 3 4 5 .        everything nearer than d is Empty and k advances by d;
///     k ->---*-------*---*-*X         otherwise the ray has ended and k stays. k is all there is:
///            . 5 4 3 3 3 4 5 .        offset(k) = start + k s0 + ((k a + 1/2) >> 16) << shift1
///                                                              + ((k b + 1/2) >> 16) << shift2
///
/// Eight rays (AVX2) advance together in one vector, and four vectors take turns, so that the
/// processor always has a gather under way while it works out where the next one goes.
///
/// @param field    FreeSpaceField::bytes()
/// @param shifts   FreeSpaceField::shifts()
/// @param start    offset of the sensor's voxel
/// @param first_k  a step up to which all rays are known to meet only Empty, at least 1
/// @param ends     of which either occupied_at or the three sets of bits, or none, are asked for
RayCounts cast_bundle(const std::uint8_t* field, const std::array<int, 3>& shifts,
                      std::int32_t start, std::int32_t first_k, const RayBundle& bundle,
                      const RayEnds& ends = {});

/// The instruction set cast_bundle uses on this processor, e.g. "AVX2".
const char* ray_kernel_target();

}  // namespace nextview
