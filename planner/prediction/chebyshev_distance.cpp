#include "planner/prediction/chebyshev_distance.h"

#include <omp.h>

#include <algorithm>

#include "sensor/vector_clones.h"

namespace nextview {

namespace {

using Byte = std::uint8_t;

NEXTVIEW_VECTOR_CLONES
void mark_obstacles(const Byte* bytes, Byte largest_free, Byte* __restrict distances,
                    std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) {
    distances[i] = bytes[i] <= largest_free ? ChebyshevDistance::kLargest : 0;
  }
}

// out[i] = the least of in[i - 1], in[i], in[i + 1].
NEXTVIEW_VECTOR_CLONES
void narrow(const Byte* in, Byte* __restrict out, std::size_t size) {
  const Byte* const left = in - 1;
  const Byte* const right = in + 1;
  for (std::size_t i = 0; i < size; ++i) out[i] = std::min(std::min(left[i], in[i]), right[i]);
}

// to[i] = at most one more than the least of three rows.
NEXTVIEW_VECTOR_CLONES
void lower(const Byte* before, const Byte* here, const Byte* after, Byte* __restrict to,
           std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) {
    const Byte least = std::min(std::min(before[i], here[i]), after[i]);
    to[i] = std::min(to[i], static_cast<Byte>(least + 1));
  }
}

// out[i] = in[i], or `by` more than in[i - by] or in[i + by].
NEXTVIEW_VECTOR_CLONES
void lower_along(const Byte* in, Byte* __restrict out, std::size_t by, std::size_t size) {
  const Byte* const left = in - by;
  const Byte* const right = in + by;
  for (std::size_t i = 0; i < size; ++i) {
    out[i] = std::min(in[i], static_cast<Byte>(std::min(left[i], right[i]) + by));
  }
}

}  // namespace

void ChebyshevDistance::resize(const VoxelIndex& cells, int threads) {
  if (cells == cells_ && threads == threads_) return;
  threads_ = threads;
  cells_ = cells;
  rows_ = cells[1];
  layers_ = cells[2];
  stride_ = (static_cast<std::size_t>(cells[0]) + 2 * kMargin - 1) / kMargin * kMargin;
  layer_ = stride_ * static_cast<std::size_t>(rows_);
  distances_.assign((layer_ + kMargin) * static_cast<std::size_t>(layers_) + kMargin, kLargest);
}

void ChebyshevDistance::fill_row(int y, int z, const Byte* bytes, Byte largest_free) {
  const auto columns = static_cast<std::size_t>(cells_[0]);
  Byte* const distances = &distances_[place(y, z)];
  mark_obstacles(bytes, largest_free, distances, columns);
  std::fill(distances + columns, distances + stride_, kLargest);
}

void ChebyshevDistance::find() {
  if (threads_ == 1) {
    lower_layers();
    finish_layers(0, layers_);
    return;
  }
#pragma omp single
  lower_layers();
  const int parts = omp_get_num_threads();
#pragma omp for schedule(static)
  for (int part = 0; part < parts; ++part) {
    finish_layers(layers_ * part / parts, layers_ * (part + 1) / parts);
  }
}

void ChebyshevDistance::lower_layers() {
  Bytes narrowed = free_layer();
  for (int z = 1; z < layers_; ++z) lower_layer(z, z - 1, narrowed);
  for (int z = layers_ - 2; z >= 0; --z) lower_layer(z, z + 1, narrowed);
}

void ChebyshevDistance::finish_layers(int begin_z, int end_z) {
  for (int y = 1; y < rows_; ++y) lower_rows(y, y - 1, begin_z, end_z);
  for (int y = rows_ - 2; y >= 0; --y) lower_rows(y, y + 1, begin_z, end_z);
  Bytes a = free_layer();
  Bytes b = free_layer();
  for (int z = begin_z; z < end_z; ++z) lower_along_rows(z, a, b);
}

void ChebyshevDistance::lower_layer(int z, int from_z, Bytes& narrowed) {
  Byte* const from = &narrowed[stride_];
  narrow(row(0, from_z), from, layer_);
  lower(from - stride_, from, from + stride_, &distances_[place(0, z)], layer_);
}

// A row of all layers at a time: a row that has just been written would be waited for.
void ChebyshevDistance::lower_rows(int y, int from_y, int begin_z, int end_z) {
  for (int z = begin_z; z < end_z; ++z) {
    const Byte* const from = row(from_y, z);
    lower(from - 1, from, from + 1, &distances_[place(y, z)], stride_);
  }
}

void ChebyshevDistance::lower_along_rows(int z, Bytes& a, Bytes& b) {
  Byte* const layer = &distances_[place(0, z)];
  Byte* const in_a = &a[stride_];
  Byte* const in_b = &b[stride_];
  lower_along(layer, in_a, 1, layer_);
  lower_along(in_a, in_b, 2, layer_);
  lower_along(in_b, in_a, 4, layer_);
  lower_along(in_a, in_b, 8, layer_);
  lower_along(in_b, layer, 16, layer_);
}

}  // namespace nextview
