#include "mapper/normals.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "mapper/normal_slopes.h"
#include "mapper/voxel_map.h"
#include "sensor/vector_clones.h"

namespace nextview {

namespace {

std::vector<float> to_float(const std::vector<double>& values) {
  std::vector<float> floats(values.size());
  std::transform(values.begin(), values.end(), floats.begin(),
                 [](double value) { return static_cast<float>(value); });
  return floats;
}

// One row of an array, its neighbours a stride before and after, and the steps to them. The arrays
// reach a stride beyond both ends.
struct RowView {
  const float* here;
  const float* previous;
  const float* next;
};
struct StepView {
  const float* cosine;
  const float* sine;
  const float* inverse_sine;
};

NEXTVIEW_VECTOR_CLONES
void invert_ranges(int columns, UsableRanges usable, const float* __restrict from,
                   float* __restrict range, float* __restrict w) {
#pragma omp simd
  for (int u = 0; u < columns; ++u) {
    range[u] = usable_range(from[u], usable);
    w[u] = 1.0f / range[u];
  }
}

NEXTVIEW_VECTOR_CLONES
void bends_along_row(int columns, RowView w, const float* __restrict d, StepView previous,
                     StepView next, float* __restrict bend) {
#pragma omp simd
  for (int u = 0; u < columns; ++u) {
    const float slope_p =
        slope_to(w.here[u], w.previous[u], previous.cosine[u], previous.inverse_sine[u]);
    const float slope_n = slope_to(w.here[u], w.next[u], next.cosine[u], next.inverse_sine[u]);
    bend[u] = relative_bend(slope_p, slope_n, d[u]);
  }
}

NEXTVIEW_VECTOR_CLONES
void choose_along_row(int columns, RowView w, RowView d, RowView bend, StepView previous,
                      StepView next, float* __restrict slope) {
#pragma omp simd
  for (int u = 0; u < columns; ++u) {
    const float slope_p =
        slope_to(w.here[u], w.previous[u], previous.cosine[u], previous.inverse_sine[u]);
    const float slope_n = slope_to(w.here[u], w.next[u], next.cosine[u], next.inverse_sine[u]);
    const float step_p =
        squared_step(d.here[u], d.previous[u], previous.cosine[u], previous.sine[u]);
    const float step_n = squared_step(d.here[u], d.next[u], next.cosine[u], next.sine[u]);
    slope[u] = choose_slope(slope_p, slope_n, bend.here[u], bend.previous[u], bend.next[u], step_p,
                            step_n);
  }
}

NEXTVIEW_VECTOR_CLONES
void bends_along_column(int columns, RowView w, const float* __restrict d,
                        const float* __restrict slope_a, const float* __restrict sin_a,
                        const float* __restrict cos_a, AngleStep previous, AngleStep next,
                        float* __restrict bend) {
#pragma omp simd
  for (int u = 0; u < columns; ++u) {
    const float c = constant_along_column(w.here[u], slope_a[u], sin_a[u], cos_a[u]);
    const float here = w.here[u] - c;
    const float slope_p = slope_to(here, w.previous[u] - c, previous.cosine, previous.inverse_sine);
    const float slope_n = slope_to(here, w.next[u] - c, next.cosine, next.inverse_sine);
    bend[u] = relative_bend(slope_p, slope_n, d[u]);
  }
}

struct NormalArrays {
  std::int32_t* __restrict x;
  std::int32_t* __restrict y;
  std::int32_t* __restrict z;
  std::int32_t* __restrict quality;
};

NEXTVIEW_VECTOR_CLONES
void normals_of_row(int columns, RowView w, RowView d, RowView bend,
                    const float* __restrict slope_a, const float* __restrict sin_a,
                    const float* __restrict cos_a, float sin_b, float cos_b, AngleStep previous,
                    AngleStep next, const float (&rotation)[3][3], NormalArrays normals) {
#pragma omp simd
  for (int u = 0; u < columns; ++u) {
    const float c = constant_along_column(w.here[u], slope_a[u], sin_a[u], cos_a[u]);
    const float here = w.here[u] - c;
    const float slope_p = slope_to(here, w.previous[u] - c, previous.cosine, previous.inverse_sine);
    const float slope_n = slope_to(here, w.next[u] - c, next.cosine, next.inverse_sine);
    const float step_p = squared_step(d.here[u], d.previous[u], previous.cosine, previous.sine);
    const float step_n = squared_step(d.here[u], d.next[u], next.cosine, next.sine);
    const float slope_b = choose_slope(slope_p, slope_n, bend.here[u], bend.previous[u],
                                       bend.next[u], step_p, step_n);
    const PointNormal normal =
        point_normal(w.here[u], slope_a[u], slope_b, {sin_a[u], cos_a[u], sin_b, cos_b}, rotation);
    normals.x[u] = normal.x;
    normals.y[u] = normal.y;
    normals.z[u] = normal.z;
    normals.quality[u] = normal.quality;
  }
}

}  // namespace

int normal_stride(const std::vector<double>& sines, const std::vector<double>& cosines) {
  const std::size_t middle = sines.size() / 2;
  const double spacing =
      std::abs(sines[middle - 1] * cosines[middle] - cosines[middle - 1] * sines[middle]);
  const int last = static_cast<int>(sines.size()) - 1;
  int stride = 1;
  while (stride < last && stride * spacing < kBaselineSine) ++stride;
  return stride;
}

AngleStep angle_step(const std::vector<double>& sines, const std::vector<double>& cosines, int from,
                     int to) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  if (to < 0 || to >= static_cast<int>(sines.size())) return {kNaN, kNaN, kNaN};
  const auto f = static_cast<std::size_t>(from);
  const auto t = static_cast<std::size_t>(to);
  const double sine = sines[t] * cosines[f] - cosines[t] * sines[f];
  const double cosine = cosines[t] * cosines[f] + sines[t] * sines[f];
  if (!(std::abs(sine) >= kSmallestSine)) return {kNaN, kNaN, kNaN};
  return {static_cast<float>(cosine), static_cast<float>(sine), static_cast<float>(1.0 / sine)};
}

void NormalEstimator::PaddedRows::resize(int columns, int new_rows, int new_pad_columns,
                                         int new_kept) {
  rows = new_rows;
  pad_columns = new_pad_columns;
  kept = new_kept;
  mask = static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::min(kept, rows)))) - 1;
  pitch = columns + 2 * pad_columns;
  // The padding is written once and never again while the shape stays.
  values.assign(static_cast<std::size_t>((mask + 2) * pitch),
                std::numeric_limits<float>::quiet_NaN());
}

NormalEstimator::Axis NormalEstimator::make_axis(const std::vector<double>& sines,
                                                 const std::vector<double>& cosines) {
  Axis axis;
  axis.stride = normal_stride(sines, cosines);
  const auto append = [&](Step& step, int from, int to) {
    const AngleStep angle = angle_step(sines, cosines, from, to);
    step.cosine.push_back(angle.cosine);
    step.sine.push_back(angle.sine);
    step.inverse_sine.push_back(angle.inverse_sine);
  };
  for (int i = 0; i < static_cast<int>(sines.size()); ++i) {
    append(axis.previous, i, i - axis.stride);
    append(axis.next, i, i + axis.stride);
  }
  return axis;
}

void NormalEstimator::prepare(const RangeImage& image) {
  const RayTable& rays = image.rays;
  image_range_m_ = image.range_m.data();
  usable_ = UsableRanges(RangeBounds(image.limits));
  next_slope_ = 0;
  next_bend_ = 0;
  column_axis_ = make_axis(rays.column_sin, rays.column_cos);
  row_axis_ = make_axis(rays.row_sin, rays.row_cos);
  column_sin_ = to_float(rays.column_sin);
  column_cos_ = to_float(rays.column_cos);
  row_sin_ = to_float(rays.row_sin);
  row_cos_ = to_float(rays.row_cos);
  const Eigen::Matrix3d world_from_lines = rays.world_from_lines(image.world_from_sensor);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rotation_[i][j] = static_cast<float>(world_from_lines(i, j));
  }
  resize(rays.columns(), rays.rows());
}

void NormalEstimator::resize(int columns, int rows) {
  // From the row above that a normal looks at to the row below that the one below looks at.
  const int kept = 3 * row_axis_.stride + 1;
  const bool same_shape = columns_ == columns && rows_ == rows && range_.kept == kept &&
                          range_.pad_columns == column_axis_.stride;
  if (same_shape) return;
  columns_ = columns;
  rows_ = rows;
  for (PaddedRows* part : {&range_, &inverse_range_, &slope_, &column_bend_}) {
    part->resize(columns, rows, column_axis_.stride, kept);
  }
  row_bend_.assign(static_cast<std::size_t>(range_.pitch), std::numeric_limits<float>::quiet_NaN());
}

void NormalEstimator::take_ranges(int v) {
  const float* const from = image_range_m_ + static_cast<std::ptrdiff_t>(v) * columns_;
  invert_ranges(columns_, usable_, from, range_.row(v), inverse_range_.row(v));
}

void NormalEstimator::slope_along_row(int v) {
  const int s = column_axis_.stride;
  const auto across = [s](const float* row) { return RowView{row, row - s, row + s}; };
  const auto steps = [](const Step& step) {
    return StepView{step.cosine.data(), step.sine.data(), step.inverse_sine.data()};
  };
  float* const bend = row_bend_.data() + range_.pad_columns;
  bends_along_row(columns_, across(inverse_range_.row(v)), range_.row(v),
                  steps(column_axis_.previous), steps(column_axis_.next), bend);
  choose_along_row(columns_, across(inverse_range_.row(v)), across(range_.row(v)), across(bend),
                   steps(column_axis_.previous), steps(column_axis_.next), slope_.row(v));
}

void NormalEstimator::bend_along_column(int v) {
  const int s = row_axis_.stride;
  const RowView w = {inverse_range_.row(v), inverse_range_.row(v - s), inverse_range_.row(v + s)};
  bends_along_column(columns_, w, range_.row(v), slope_.row(v), column_sin_.data(),
                     column_cos_.data(), row_axis_.previous.at(v), row_axis_.next.at(v),
                     column_bend_.row(v));
}

void NormalEstimator::row(int v, NormalRow& normals) {
  for (auto* part : {&normals.x, &normals.y, &normals.z, &normals.quality}) {
    part->resize(static_cast<std::size_t>(columns_ + NormalRow::kPadding));
  }
  const int s = row_axis_.stride;
  for (; next_slope_ < std::min(rows_, v + 2 * s + 1); ++next_slope_) {
    take_ranges(next_slope_);
    slope_along_row(next_slope_);
  }
  for (; next_bend_ < std::min(rows_, v + s + 1); ++next_bend_) bend_along_column(next_bend_);

  const auto down = [&](const PaddedRows& rows) {
    return RowView{rows.row(v), rows.row(v - s), rows.row(v + s)};
  };
  const auto i = static_cast<std::size_t>(v);
  normals_of_row(columns_, down(inverse_range_), down(range_), down(column_bend_), slope_.row(v),
                 column_sin_.data(), column_cos_.data(), row_sin_[i], row_cos_[i],
                 row_axis_.previous.at(v), row_axis_.next.at(v), rotation_,
                 {normals.x.data(), normals.y.data(), normals.z.data(), normals.quality.data()});
}

std::size_t NormalEstimator::memory_bytes() const {
  std::size_t floats = row_bend_.capacity();
  for (const PaddedRows* rows : {&range_, &inverse_range_, &slope_, &column_bend_}) {
    floats += rows->values.capacity();
  }
  return floats * sizeof(float);
}

}  // namespace nextview
