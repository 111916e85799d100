#include "mapper/pixel_runs.h"

#include <algorithm>

// Highway compiles the rest of this file once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mapper/pixel_runs.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "mapper/store_kept-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nextview::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
// Most runs are shorter than nine pixels.
using Tag = hn::CappedTag<std::int32_t, 8>;
using Vector = hn::Vec<Tag>;
using WideTag = hn::CappedTag<std::int32_t, std::min(NormalRow::kPadding, EndRow::kPadding)>;

// The columns at which runs begin; returns how many.
std::size_t FindBegins(int columns, const RowEnds& ends, std::int32_t* begins) {
  const WideTag d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  std::size_t size = 0;
  for (int u = 0; u < columns; u += lanes) {
    const auto change = [&](const std::int32_t* row) HWY_ATTR {
      return hn::Xor(hn::LoadU(d, row + u), hn::LoadU(d, row + u - 1));
    };
    const auto differs = hn::Or(hn::Or(change(ends.voxel[0]), change(ends.voxel[1])),
                                hn::Or(change(ends.voxel[2]), change(ends.kind)));
    const auto column = hn::Iota(d, u);
    const auto too_long = hn::Eq(hn::And(column, hn::Set(d, 0xffff)), hn::Zero(d));
    const auto begin = hn::And(hn::Lt(column, hn::Set(d, columns)),
                               hn::Or(hn::Ne(differs, hn::Zero(d)), too_long));
    size += store_kept(d, column, begin, begins + size);
  }
  return size;
}

// See PixelRuns::find_other_lines; returns how many.
std::size_t FindOtherLines(int columns, const RowEnds& ends, const RowEnds& above,
                           std::int32_t* found) {
  const WideTag d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  std::size_t size = 0;
  for (int u = 0; u < columns; u += lanes) {
    const auto change = [&](const RowEnds& from, int step) HWY_ATTR {
      const auto of = [&](const std::int32_t* here, const std::int32_t* there) HWY_ATTR {
        return hn::Xor(hn::LoadU(d, here + u), hn::LoadU(d, there + u - step));
      };
      return hn::Or(
          hn::Or(hn::Or(of(ends.voxel[0], from.voxel[0]), of(ends.kind, from.kind)),
                 hn::Or(of(ends.voxel[1], from.voxel[1]), of(ends.voxel[2], from.voxel[2]))),
          of(ends.limit, from.limit));
    };
    const auto column = hn::Iota(d, u);
    const auto from_left =
        hn::Or(hn::Ne(change(ends, 1), hn::Zero(d)), hn::Eq(column, hn::Zero(d)));
    const auto from_above = hn::Ne(change(above, 0), hn::Zero(d));
    const auto is_other =
        hn::And(hn::Lt(column, hn::Set(d, columns)), hn::And(from_left, from_above));
    size += store_kept(d, column, is_other, found + size);
  }
  return size;
}

HWY_INLINE void reduce(Vector x, Vector y, Vector z, Vector count, Vector quality, PixelRun& run) {
  const Tag d;
  run.normal_sum[0] = hn::GetLane(hn::SumOfLanes(d, x));
  run.normal_sum[1] = hn::GetLane(hn::SumOfLanes(d, y));
  run.normal_sum[2] = hn::GetLane(hn::SumOfLanes(d, z));
  run.normal_sum[3] = hn::GetLane(hn::SumOfLanes(d, count));
  run.quality = hn::GetLane(hn::MaxOfLanes(d, quality));
}

void SumRuns(const NormalRow& normals, std::span<PixelRun> runs) {
  const Tag d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (PixelRun& run : runs) {
    Vector x = hn::Zero(d);
    Vector y = hn::Zero(d);
    Vector z = hn::Zero(d);
    Vector count = hn::Zero(d);
    Vector quality = hn::Zero(d);
    for (int u = run.begin; u < run.end; u += lanes) {
      const auto mask = hn::FirstN(d, static_cast<std::size_t>(run.end - u));
      const auto part = [&](const std::vector<std::int32_t>& row) HWY_ATTR {
        return hn::IfThenElseZero(mask, hn::LoadU(d, &row[static_cast<std::size_t>(u)]));
      };
      const Vector add_x = part(normals.x);
      const Vector add_y = part(normals.y);
      const Vector add_z = part(normals.z);
      const auto has_normal = hn::Ne(hn::Or(hn::Or(add_x, add_y), add_z), hn::Zero(d));
      x = hn::Add(x, add_x);
      y = hn::Add(y, add_y);
      z = hn::Add(z, add_z);
      count = hn::Sub(count, hn::VecFromMask(d, has_normal));
      quality = hn::Max(quality, part(normals.quality));
    }
    reduce(x, y, z, count, quality, run);
  }
}

}  // namespace
}  // namespace nextview::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nextview {

namespace {
HWY_EXPORT(FindBegins);
HWY_EXPORT(FindOtherLines);
HWY_EXPORT(SumRuns);
}  // namespace

std::span<const PixelRun> PixelRuns::find(int columns, const RowEnds& ends,
                                          const NormalRow& normals) {
  columns_.resize(static_cast<std::size_t>(columns + NormalRow::kPadding));
  runs_.resize(static_cast<std::size_t>(columns));
  const std::size_t size = HWY_DYNAMIC_DISPATCH(FindBegins)(columns, ends, columns_.data());
  columns_[size] = columns;
  for (std::size_t n = 0; n < size; ++n) {
    runs_[n].begin = columns_[n];
    runs_[n].end = columns_[n + 1];
  }
  const std::span<PixelRun> runs(runs_.data(), size);
  HWY_DYNAMIC_DISPATCH(SumRuns)(normals, runs);
  return runs;
}

std::span<const std::int32_t> PixelRuns::find_other_lines(int columns, const RowEnds& ends,
                                                          const RowEnds& above) {
  columns_.resize(static_cast<std::size_t>(columns + NormalRow::kPadding));
  const std::size_t size =
      HWY_DYNAMIC_DISPATCH(FindOtherLines)(columns, ends, above, columns_.data());
  return {columns_.data(), size};
}

}  // namespace nextview
#endif
