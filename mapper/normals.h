#pragma once

#include <cstdint>
#include <vector>

#include "mapper/normal_slopes.h"
#include "sensor/range_image.h"

namespace nextview {

/// Surface normals of one row of a range image, as the map sums them (SurfaceVoxel).
struct NormalRow {
  /// The arrays go on for this many pixels beyond the row, for those who read whole vectors.
  static constexpr int kPadding = 16;
  /// World frame, towards the sensor, in 1/SurfaceVoxel::kNormalUnit; (0, 0, 0) where there is
  /// none.
  std::vector<std::int32_t> x, y, z;
  /// |cos(normal, viewing ray)| in 1/SurfaceVoxel::kQualityUnit; 0 where there is no normal.
  std::vector<std::int32_t> quality;
};

/// Estimates the surface normal at every point of a range image from its neighbours in the image
/// (P9): exact on planes, up to the quantisation of the ranges.
///
/// On a plane { p : m . p = 1 } (line frame) the inverse range w is linear in the ray:
/// w = m . n(a, b), with n the ray at column angle a and row angle b (ray_table.h). n, n_a = dn/da
/// and e_b = (dn/db) / cos a are orthonormal (RayFrame), so w and its two derivatives give the
/// plane:
///
///     m = w n + w_a n_a + (w_b / cos a) e_b,    normal = -m / |m| towards the sensor,
///     |cos(normal, ray)| = w / |m|.
///
/// The derivatives need no limit: along a row w = A cos a + B sin a, so from one other pixel at a +
/// h
///     w_a = (w(a+h) - w(a) cos h) / sin h                      exactly; and along a column
///     w_b = ((w(b+h) - C) - (w(b) - C) cos h) / sin h          exactly,
/// with C = m_x (-sin a) the part that does not change along it, known from w_a.
///
/// Each derivative so has two candidates, from the pixel before and the pixel after. On a plane
/// they agree and their mean is taken. Where they do not, at a crease or an edge, that side is
/// taken whose own neighbour further on confirms it (choose_slope in normal_slopes.h). A pixel with
/// no usable neighbour on an axis has no normal. Neighbours are taken at least 0.9 degrees away, so
/// that dense images suffer no more from noise than the paper's sensor.
///
/// Only additions, multiplications, divisions and square roots of floats in a fixed order: the same
/// bits from any compiler. Only points have a normal, and of these only those within [1 mm, 1000
/// km].
class NormalEstimator {
 public:
  /// Begins an image with as many ranges as its table has pixels, at least 2 x 2. Its ranges are
  /// read row by row: it must live until its last row has been asked for.
  void prepare(const RangeImage& image);

  /// The normals of row v of the image prepared last. Rows are asked for in order, from 0 on: what
  /// their neighbourhoods share is worked out on the way and kept no longer than it is needed.
  void row(int v, NormalRow& normals);

  std::size_t memory_bytes() const;

 private:
  /// Along one axis of the image, the angle from each pixel to the one a stride before or after.
  /// All NaN where there is none.
  struct Step {
    std::vector<float> cosine, sine, inverse_sine;
    AngleStep at(int i) const {
      const auto n = static_cast<std::size_t>(i);
      return {cosine[n], sine[n], inverse_sine[n]};
    }
  };
  struct Axis {
    int stride = 1;
    Step previous, next;
  };
  /// The rows of an image at work, with NaN around, so that neighbours outside the image read NaN.
  /// A row takes the place of one that lies at least `kept` above it.
  struct PaddedRows {
    void resize(int columns, int rows, int pad_columns, int kept);
    const float* row(int v) const { return values.data() + place(v); }
    float* row(int v) { return values.data() + place(v); }
    std::ptrdiff_t place(int v) const {
      // The row after the last kept one stands for all rows above and below the image.
      const bool inside = static_cast<unsigned>(v) < static_cast<unsigned>(rows);
      return (inside ? v & mask : mask + 1) * pitch + pad_columns;
    }
    std::vector<float> values;
    int rows = 0, pad_columns = 0, kept = 0;
    int mask = 0;  ///< a power of two of rows are kept; this is one less
    std::ptrdiff_t pitch = 0;
  };

  static Axis make_axis(const std::vector<double>& sines, const std::vector<double>& cosines);
  void resize(int columns, int rows);
  void take_ranges(int v);
  void slope_along_row(int v);
  void bend_along_column(int v);

  const float* image_range_m_ = nullptr;
  UsableRanges usable_{RangeBounds(RangeLimits())};
  int columns_ = 0;
  int rows_ = 0;
  int next_slope_ = 0;  ///< the first row without slope
  int next_bend_ = 0;   ///< the first row without column bend
  Axis column_axis_;    ///< from column to column
  Axis row_axis_;       ///< from row to row
  std::vector<float> column_sin_, column_cos_, row_sin_, row_cos_;
  float rotation_[3][3] = {};    ///< world_from_lines
  PaddedRows range_;             ///< metres; NaN where there is no point
  PaddedRows inverse_range_;     ///< w
  PaddedRows slope_;             ///< w_a as chosen
  PaddedRows column_bend_;       ///< how far the two candidates for w_b are apart, times the range
  std::vector<float> row_bend_;  ///< the same for w_a, of the row at work, padded
};

}  // namespace nextview
