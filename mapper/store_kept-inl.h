// Included once for every instruction set (Highway).
#if defined(NEXTVIEW_MAPPER_STORE_KEPT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NEXTVIEW_MAPPER_STORE_KEPT_INL_H_
#undef NEXTVIEW_MAPPER_STORE_KEPT_INL_H_
#else
#define NEXTVIEW_MAPPER_STORE_KEPT_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace nextview::HWY_NAMESPACE {
namespace {

// Stores the lanes a mask keeps, one after the other, and returns how many. To where a whole vector
// fits: what lies beyond the kept ones may be overwritten.
template <class D, class Mask>
HWY_INLINE std::size_t store_kept(D d, hwy::HWY_NAMESPACE::Vec<D> lanes, Mask keep,
                                  std::int32_t* to) {
  namespace hn = hwy::HWY_NAMESPACE;
#if HWY_TARGET <= HWY_AVX3
  hn::StoreU(hn::Compress(lanes, keep), d, to);
  return hn::CountTrue(d, keep);
#else
  // Without an instruction for it Highway takes a table, which GCC copies at every call.
  alignas(64) std::int32_t values[hn::MaxLanes(D())];
  alignas(64) std::int32_t kept[hn::MaxLanes(D())];
  hn::Store(lanes, d, values);
  hn::Store(hn::VecFromMask(d, keep), d, kept);  // -1 where kept
  std::size_t size = 0;
  for (std::size_t n = 0; n < hn::Lanes(d); ++n) {
    to[size] = values[n];
    size += static_cast<std::size_t>(-kept[n]);
  }
  return size;
#endif
}

}  // namespace
}  // namespace nextview::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
