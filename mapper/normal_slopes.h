#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "mapper/voxel_map.h"

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

/// The range, or NaN where it can give no normal.
inline float usable_range(float range_m) {
  return range_m >= 1e-3f && range_m <= 1e6f ? range_m : std::numeric_limits<float>::quiet_NaN();
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

/// The slope seen from one side.
struct SlopeCandidate {
  float slope;         ///< NaN when that neighbour is missing
  float bend;          ///< relative_bend at that neighbour: small if the one beyond it confirms the
                       ///< slope, NaN if there is none beyond it
  float squared_step;  ///< to that neighbour
};

/// Chooses between the slopes of both sides. bend is the pixel's own, NaN when a side is missing.
inline float choose_slope(const SlopeCandidate& previous, const SlopeCandidate& next, float bend) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  // A slope that nothing confirms or contradicts counts as barely confirmed.
  const float previous_bend = previous.bend == previous.bend ? previous.bend : kLargestBend;
  const float next_bend = next.bend == next.bend ? next.bend : kLargestBend;
  const bool previous_fits = previous_bend <= kLargestBend;
  const bool next_fits = next_bend <= kLargestBend;
  const float mean = 0.5f * (previous.slope + next.slope);

  // Both sides contradicted, as in noise: the mean, unless one side lies across a jump.
  const float unconfirmed = next.squared_step > 4.0f * previous.squared_step   ? previous.slope
                            : previous.squared_step > 4.0f * next.squared_step ? next.slope
                                                                               : mean;
  // A crease or an edge: the side that is confirmed, or confirmed better.
  const float confirmed = previous_bend < next_bend ? previous.slope : next.slope;
  const float one_sided = previous_fits | next_fits ? confirmed : unconfirmed;
  const float both = bend <= kLargestBend ? mean : one_sided;

  // With one side only, it must not be contradicted.
  const float only_previous = previous_fits ? previous.slope : kNaN;
  const float only_next = next_fits ? next.slope : kNaN;
  const bool has_previous = previous.slope == previous.slope;
  const bool has_next = next.slope == next.slope;
  return has_previous ? (has_next ? both : only_previous) : only_next;
}

/// A normal as the map sums it; see NormalRow.
struct PointNormal {
  std::int32_t x, y, z, quality;
};

inline std::int32_t round_to_integer(float value) {
  return static_cast<std::int32_t>(value + std::copysign(0.5f, value));
}

/// The normal from w and its slopes at ray angles a, b; all zero when any of them is NaN.
inline PointNormal point_normal(float w, float slope_a, float slope_b, float sin_a, float cos_a,
                                float sin_b, float cos_b, const float (&world_from_sensor)[3][3]) {
  // m in the frame of the row: x, along the row's plane, and across it.
  const float across = slope_b / cos_a;
  const float along = cos_a * w - sin_a * slope_a;
  const float x = -(sin_a * w) - cos_a * slope_a;
  const float y = along * cos_b - across * sin_b;
  const float z = along * sin_b + across * cos_b;
  const float length = std::sqrt(w * w + slope_a * slope_a + across * across);
  const bool valid = length > 0.0f && length < 1e15f;
  const float inverse = valid ? 1.0f / length : 0.0f;
  const float unit = -static_cast<float>(SurfaceVoxel::kNormalUnit) * inverse;
  const auto component = [&](int i) {
    const float* const r = world_from_sensor[i];
    const float value = (r[0] * x + r[1] * y + r[2] * z) * unit;
    return round_to_integer(valid ? value : 0.0f);
  };
  const float quality = static_cast<float>(SurfaceVoxel::kQualityUnit) * (w * inverse);
  return {component(0), component(1), component(2), round_to_integer(valid ? quality : 0.0f)};
}

}  // namespace nextview
