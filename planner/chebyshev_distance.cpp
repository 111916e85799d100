#include "planner/chebyshev_distance.h"

#include <algorithm>

#include "mapper/vector_clones.h"

namespace nextview {

namespace {

using Byte = std::uint8_t;

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

}  // namespace

void ChebyshevDistance::resize(const VoxelIndex& cells) {
  rows_ = cells[1];
  layers_ = cells[2];
  stride_ = (static_cast<std::size_t>(cells[0]) + 2 * kMargin - 1) / kMargin * kMargin;
  layer_ = stride_ * static_cast<std::size_t>(rows_);
  distances_.assign((layer_ + kMargin) * static_cast<std::size_t>(layers_) + kMargin, kLargest);
  narrowed_.assign(layer_ + 2 * stride_, kLargest);
  lowered_.assign(layer_ + 2 * stride_, kLargest);
}

void ChebyshevDistance::find() {
  for (int z = 1; z < layers_; ++z) lower_layer(z, z - 1);
  for (int z = layers_ - 2; z >= 0; --z) lower_layer(z, z + 1);
  for (int y = 1; y < rows_; ++y) lower_rows(y, y - 1);
  for (int y = rows_ - 2; y >= 0; --y) lower_rows(y, y + 1);
  for (int z = 0; z < layers_; ++z) lower_along_rows(z);
}

void ChebyshevDistance::lower_layer(int z, int from_z) {
  Byte* const narrowed = &narrowed_[stride_];
  narrow(row(0, from_z), narrowed, layer_);
  lower(narrowed - stride_, narrowed, narrowed + stride_, row(0, z), layer_);
}

void ChebyshevDistance::lower_rows(int y, int from_y) {
  for (int z = 0; z < layers_; ++z) {
    const Byte* const from = row(from_y, z);
    lower(from - 1, from, from + 1, row(y, z), stride_);
  }
}

void ChebyshevDistance::lower_along_rows(int z) {
  Byte* const layer = row(0, z);
  Byte* const a = &narrowed_[stride_];
  Byte* const b = &lowered_[stride_];
  lower_along(layer, a, 1, layer_);
  lower_along(a, b, 2, layer_);
  lower_along(b, a, 4, layer_);
  lower_along(a, b, 8, layer_);
  lower_along(b, layer, 16, layer_);
}

}  // namespace nextview
