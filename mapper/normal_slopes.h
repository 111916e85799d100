#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "mapper/voxel_map.h"
#include "sensor/range_image.h"

namespace nextview {

/// The arithmetic of one pixel's normal (see normals.h for the idea), shared by the estimator and
/// its plain twin, so that both round alike. Nothing branches: missing values are NaN and fall
/// through comparisons, which lets compilers work on a register full of pixels at a time.

/// Neighbours stand at least this far from a pixel: the sine of 0.9 degrees.
constexpr double kBaselineSine = 0.0157;
/// Rays nearer to each other than this give no slope.
constexpr double kSmallestSine = 1e-6;
/// Two slopes that bend a surface by no more than this many radians agree. Quantising ranges to
/// 0.1 mm can fake a bend of 0.029 at 0.4 m, and less farther away; the mean of two slopes that
/// agree is at most half of this from either.
constexpr float kLargestBend = 0.03f;

/// How many pixels along an axis of the image the neighbours stand away.
int normal_stride(const std::vector<double>& sines, const std::vector<double>& cosines);

/// Cosine, sine and 1/sine of the angle between two rays of an axis; all NaN when there is none.
struct AngleStep {
  float cosine, sine, inverse_sine;
};
AngleStep angle_step(const std::vector<double>& sines, const std::vector<double>& cosines, int from,
                     int to);

/// condition ? yes : no, without a branch: compilers make branches of nested conditions, and with
/// branches they do not vectorise.
inline float select(bool condition, float yes, float no) {
  const std::uint32_t mask = -static_cast<std::uint32_t>(condition);
  return std::bit_cast<float>((std::bit_cast<std::uint32_t>(yes) & mask) |
                              (std::bit_cast<std::uint32_t>(no) & ~mask));
}
inline bool is_number(float value) { return value == value; }

/// The ranges that can give a normal: those of points (RangeKind), within [1 mm, 1000 km].
struct UsableRanges {
  explicit UsableRanges(const RangeBounds& bounds)
      : nearest_m(std::max(1e-3f, bounds.nearest_m)),
        farthest_m(std::min(1e6f, bounds.farthest_m)) {}
  float nearest_m;
  float farthest_m;
};

/// The range, or NaN where it can give no normal.
inline float usable_range(float range_m, const UsableRanges& ranges) {
  const bool usable = (range_m >= ranges.nearest_m) & (range_m <= ranges.farthest_m);
  return select(usable, range_m, std::numeric_limits<float>::quiet_NaN());
}

/// dw/d(angle) at a pixel from its w and a neighbour's.
inline float slope_to(float w, float w_neighbour, float cosine, float inverse_sine) {
  return (w_neighbour - w * cosine) * inverse_sine;
}

/// By how many radians, about, a surface turns at a pixel that sees two slopes.
inline float relative_bend(float slope_previous, float slope_next, float range_m) {
  return std::abs(slope_next - slope_previous) * range_m;
}

/// The square of the distance between the points of two neighbouring pixels.
inline float squared_step(float range_m, float neighbour_m, float cosine, float sine) {
  const float along = neighbour_m - range_m * cosine;
  const float across = range_m * sine;
  return along * along + across * across;
}

/// C of normals.h: the part of w that is the same along a column.
inline float constant_along_column(float w, float slope_a, float sin_a, float cos_a) {
  return sin_a * (sin_a * w + cos_a * slope_a);
}

/// Chooses between the slopes seen from both sides.
/// @param previous, next  the slopes; NaN when that neighbour is missing
/// @param bend            relative_bend at the pixel itself; NaN when a neighbour is missing
/// @param bend_previous, bend_next  the same at its neighbours: small if the pixel beyond confirms
///                        the slope, NaN if there is none beyond
/// @param step_previous, step_next  squared_step to the neighbours
inline float choose_slope(float previous, float next, float bend, float bend_previous,
                          float bend_next, float step_previous, float step_next) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  // A slope that nothing confirms or contradicts counts as barely confirmed.
  bend_previous = select(is_number(bend_previous), bend_previous, kLargestBend);
  bend_next = select(is_number(bend_next), bend_next, kLargestBend);
  const bool previous_fits = bend_previous <= kLargestBend;
  const bool next_fits = bend_next <= kLargestBend;
  const float mean = 0.5f * (previous + next);

  // Both sides contradicted, as in noise: the mean, unless one side lies across a jump.
  const bool jump_next = step_next > 4.0f * step_previous;
  const bool jump_previous = step_previous > 4.0f * step_next;
  const float unconfirmed = select(jump_next, previous, select(jump_previous, next, mean));
  // A crease or an edge: the side that is confirmed, or confirmed better.
  const float confirmed = select(bend_previous < bend_next, previous, next);
  const float one_sided = select(previous_fits | next_fits, confirmed, unconfirmed);
  const float both = select(bend <= kLargestBend, mean, one_sided);

  // With one side only, it must not be contradicted.
  const float only_previous = select(previous_fits, previous, kNaN);
  const float only_next = select(next_fits, next, kNaN);
  const float with_previous = select(is_number(next), both, only_previous);
  return select(is_number(previous), with_previous, only_next);
}

inline std::int32_t round_to_integer(float value) {
  return static_cast<std::int32_t>(value + std::copysign(0.5f, value));
}

/// A normal as the map sums it; see NormalRow.
struct PointNormal {
  std::int32_t x, y, z, quality;
};

/// The normal from w and its slopes at ray angles a, b; all zero when any of them is NaN.
/// @param ray of the pixel; by value, because loops that hand a reference to it on are not
/// vectorised
/// @param r   world_from_lines
inline PointNormal point_normal(float w, float slope_a, float slope_b, RayFrame<float> ray,
                                const float (&r)[3][3]) {
  const float across = slope_b / ray.cos_a;
  const auto [x, y, z] = ray.vector(w, slope_a, across);  // m
  const float length = std::sqrt(w * w + slope_a * slope_a + across * across);
  const bool valid = (length > 0.0f) & (length < 1e15f);
  const float inverse = 1.0f / select(valid, length, 1.0f);
  const float unit = -static_cast<float>(SurfaceVoxel::kNormalUnit) * inverse;
  const float world_x = (r[0][0] * x + r[0][1] * y + r[0][2] * z) * unit;
  const float world_y = (r[1][0] * x + r[1][1] * y + r[1][2] * z) * unit;
  const float world_z = (r[2][0] * x + r[2][1] * y + r[2][2] * z) * unit;
  const float quality = static_cast<float>(SurfaceVoxel::kQualityUnit) * (w * inverse);
  return {round_to_integer(select(valid, world_x, 0.0f)),
          round_to_integer(select(valid, world_y, 0.0f)),
          round_to_integer(select(valid, world_z, 0.0f)),
          round_to_integer(select(valid, quality, 0.0f))};
}

}  // namespace nextview
