#include "mapper/normals.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mapper/normal_slopes.h"
#include "mapper/voxel_map.h"

namespace nextview {

namespace {

std::vector<float> to_float(const std::vector<double>& values) {
  std::vector<float> floats(values.size());
  std::transform(values.begin(), values.end(), floats.begin(),
                 [](double value) { return static_cast<float>(value); });
  return floats;
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

void NormalEstimator::PaddedRows::resize(int new_columns, int new_rows, int new_pad_columns,
                                         int new_pad_rows) {
  columns = new_columns;
  rows = new_rows;
  pad_columns = new_pad_columns;
  pad_rows = new_pad_rows;
  pitch = columns + 2 * pad_columns;
  const auto size = static_cast<std::size_t>(pitch * (rows + 2 * pad_rows));
  // The padding is written once and never again while the shape stays.
  values.assign(size, std::numeric_limits<float>::quiet_NaN());
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
  columns_ = rays.columns();
  column_axis_ = make_axis(rays.column_sin, rays.column_cos);
  row_axis_ = make_axis(rays.row_sin, rays.row_cos);
  column_sin_ = to_float(rays.column_sin);
  column_cos_ = to_float(rays.column_cos);
  row_sin_ = to_float(rays.row_sin);
  row_cos_ = to_float(rays.row_cos);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      rotation_[i][j] = static_cast<float>(image.world_from_sensor(i, j));
    }
  }
  const bool same_shape = range_.columns == columns_ && range_.rows == rays.rows() &&
                          range_.pad_columns == column_axis_.stride &&
                          range_.pad_rows == row_axis_.stride;
  if (!same_shape) {
    for (PaddedRows* rows : {&range_, &inverse_range_, &slope_, &column_bend_}) {
      rows->resize(columns_, rays.rows(), column_axis_.stride, row_axis_.stride);
    }
    row_bend_.assign(static_cast<std::size_t>(range_.pitch),
                     std::numeric_limits<float>::quiet_NaN());
  }
  take_ranges(image);
  for (int v = 0; v < rays.rows(); ++v) slope_along_row(v);
  for (int v = 0; v < rays.rows(); ++v) bend_along_column(v);
}

void NormalEstimator::take_ranges(const RangeImage& image) {
  const float* from = image.range_m.data();
  for (int v = 0; v < image.rays.rows(); ++v, from += columns_) {
    float* const range = range_.row(v);
    float* const w = inverse_range_.row(v);
    for (int u = 0; u < columns_; ++u) {
      range[u] = usable_range(from[u]);
      w[u] = 1.0f / range[u];
    }
  }
}

void NormalEstimator::slope_along_row(int v) {
  const int s = column_axis_.stride;
  const Step& previous = column_axis_.previous;
  const Step& next = column_axis_.next;
  const float* const w = inverse_range_.row(v);
  const float* const d = range_.row(v);
  float* const bend = row_bend_.data() + range_.pad_columns;
  float* const chosen = slope_.row(v);
  for (int u = 0; u < columns_; ++u) {
    const float slope_p = slope_to(w[u], w[u - s], previous.cosine[u], previous.inverse_sine[u]);
    const float slope_n = slope_to(w[u], w[u + s], next.cosine[u], next.inverse_sine[u]);
    bend[u] = relative_bend(slope_p, slope_n, d[u]);
  }
  for (int u = 0; u < columns_; ++u) {
    const float slope_p = slope_to(w[u], w[u - s], previous.cosine[u], previous.inverse_sine[u]);
    const float slope_n = slope_to(w[u], w[u + s], next.cosine[u], next.inverse_sine[u]);
    const float step_p = squared_step(d[u], d[u - s], previous.cosine[u], previous.sine[u]);
    const float step_n = squared_step(d[u], d[u + s], next.cosine[u], next.sine[u]);
    chosen[u] =
        choose_slope({slope_p, bend[u - s], step_p}, {slope_n, bend[u + s], step_n}, bend[u]);
  }
}

void NormalEstimator::bend_along_column(int v) {
  const auto i = static_cast<std::size_t>(v);
  const int s = row_axis_.stride;
  const Step& previous = row_axis_.previous;
  const Step& next = row_axis_.next;
  const float* const w = inverse_range_.row(v);
  const float* const w_previous = inverse_range_.row(v - s);
  const float* const w_next = inverse_range_.row(v + s);
  const float* const d = range_.row(v);
  const float* const slope = slope_.row(v);
  float* const bend = column_bend_.row(v);
  for (int u = 0; u < columns_; ++u) {
    const float c = constant_along_column(w[u], slope[u], column_sin_[u], column_cos_[u]);
    const float here = w[u] - c;
    const float slope_p =
        slope_to(here, w_previous[u] - c, previous.cosine[i], previous.inverse_sine[i]);
    const float slope_n = slope_to(here, w_next[u] - c, next.cosine[i], next.inverse_sine[i]);
    bend[u] = relative_bend(slope_p, slope_n, d[u]);
  }
}

void NormalEstimator::row(int v, NormalRow& normals) const {
  for (auto* part : {&normals.x, &normals.y, &normals.z, &normals.quality}) {
    part->resize(static_cast<std::size_t>(columns_));
  }
  const auto i = static_cast<std::size_t>(v);
  const int s = row_axis_.stride;
  const Step& previous = row_axis_.previous;
  const Step& next = row_axis_.next;
  const float* const w = inverse_range_.row(v);
  const float* const w_previous = inverse_range_.row(v - s);
  const float* const w_next = inverse_range_.row(v + s);
  const float* const d = range_.row(v);
  const float* const d_previous = range_.row(v - s);
  const float* const d_next = range_.row(v + s);
  const float* const slope_a = slope_.row(v);
  const float* const bend = column_bend_.row(v);
  const float* const bend_previous = column_bend_.row(v - s);
  const float* const bend_next = column_bend_.row(v + s);
  for (int u = 0; u < columns_; ++u) {
    const float sa = column_sin_[u];
    const float ca = column_cos_[u];
    const float c = constant_along_column(w[u], slope_a[u], sa, ca);
    const float here = w[u] - c;
    const SlopeCandidate p = {
        slope_to(here, w_previous[u] - c, previous.cosine[i], previous.inverse_sine[i]),
        bend_previous[u], squared_step(d[u], d_previous[u], previous.cosine[i], previous.sine[i])};
    const SlopeCandidate n = {slope_to(here, w_next[u] - c, next.cosine[i], next.inverse_sine[i]),
                              bend_next[u],
                              squared_step(d[u], d_next[u], next.cosine[i], next.sine[i])};
    const float slope_b = choose_slope(p, n, bend[u]);
    const PointNormal normal =
        point_normal(w[u], slope_a[u], slope_b, sa, ca, row_sin_[i], row_cos_[i], rotation_);
    normals.x[u] = normal.x;
    normals.y[u] = normal.y;
    normals.z[u] = normal.z;
    normals.quality[u] = normal.quality;
  }
}

std::size_t NormalEstimator::memory_bytes() const {
  std::size_t floats = row_bend_.capacity();
  for (const PaddedRows* rows : {&range_, &inverse_range_, &slope_, &column_bend_}) {
    floats += rows->values.capacity();
  }
  return floats * sizeof(float);
}

}  // namespace nextview
