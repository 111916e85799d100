#include "planner/chebyshev_distance.h"

#include <omp.h>

#include <algorithm>

#include "sensor_sim/vector_clones.h"

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
  for (std::size_t i = 0; i < size; ++i) out[i] = std::min(std::min(in[i - 1], in[i]), in[i + 1]);
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

// to[i] = at most in[i].
NEXTVIEW_VECTOR_CLONES
void lower_to(const Byte* in, Byte* __restrict to, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) to[i] = std::min(to[i], in[i]);
}

}  // namespace

void ChebyshevDistance::resize(const VoxelIndex& cells, int threads) {
  if (cells == cells_ && (threads > 1) == !downwards_.empty()) return;
  cells_ = cells;
  rows_ = cells[1];
  layers_ = cells[2];
  stride_ = (static_cast<std::size_t>(cells[0]) + 2 * kMargin - 1) / kMargin * kMargin;
  layer_ = stride_ * static_cast<std::size_t>(rows_);
  distances_.assign((layer_ + kMargin) * static_cast<std::size_t>(layers_) + kMargin, kLargest);
  downwards_.assign(threads > 1 ? distances_.size() : 0, kLargest);
}

void ChebyshevDistance::fill_row(int y, int z, const Byte* bytes, Byte largest_free) {
  const auto columns = static_cast<std::size_t>(cells_[0]);
  Byte* const distances = &distances_[place(y, z)];
  mark_obstacles(bytes, largest_free, distances, columns);
  std::fill(distances + columns, distances + stride_, kLargest);
  if (!downwards_.empty()) std::copy_n(distances, stride_, &downwards_[place(y, z)]);
}

void ChebyshevDistance::find() {
  if (downwards_.empty()) {
    go_up(distances_);
    go_down(distances_);
    finish_layers(0, layers_);
    return;
  }
#pragma omp sections
  {
#pragma omp section
    go_up(distances_);
#pragma omp section
    go_down(downwards_);
  }
  const int parts = omp_get_num_threads();
#pragma omp for
  for (int part = 0; part < parts; ++part) {
    const int begin_z = layers_ * part / parts;
    const int end_z = layers_ * (part + 1) / parts;
    const std::size_t begin = place(0, begin_z);
    lower_to(&downwards_[begin], &distances_[begin], place(0, end_z) - begin);
    finish_layers(begin_z, end_z);
  }
}

void ChebyshevDistance::go_up(Bytes& distances) const {
  Bytes narrowed = free_layer();
  for (int z = 1; z < layers_; ++z) lower_layer(distances, z, z - 1, narrowed);
}

void ChebyshevDistance::go_down(Bytes& distances) const {
  Bytes narrowed = free_layer();
  for (int z = layers_ - 2; z >= 0; --z) lower_layer(distances, z, z + 1, narrowed);
}

void ChebyshevDistance::finish_layers(int begin_z, int end_z) {
  for (int y = 1; y < rows_; ++y) lower_rows(y, y - 1, begin_z, end_z);
  for (int y = rows_ - 2; y >= 0; --y) lower_rows(y, y + 1, begin_z, end_z);
  Bytes a = free_layer();
  Bytes b = free_layer();
  for (int z = begin_z; z < end_z; ++z) lower_along_rows(z, a, b);
}

void ChebyshevDistance::lower_layer(Bytes& distances, int z, int from_z, Bytes& narrowed) const {
  Byte* const from = &narrowed[stride_];
  narrow(&distances[place(0, from_z)], from, layer_);
  lower(from - stride_, from, from + stride_, &distances[place(0, z)], layer_);
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
