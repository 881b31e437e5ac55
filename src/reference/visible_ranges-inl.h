// SPDX-License-Identifier: Apache-2.0
// Vector form of TransferIntervals::visible().
#if defined(LAMINA_REFERENCE_VISIBLE_RANGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_REFERENCE_VISIBLE_RANGES_INL_H_
#undef LAMINA_REFERENCE_VISIBLE_RANGES_INL_H_
#else
#define LAMINA_REFERENCE_VISIBLE_RANGES_INL_H_
#endif

#include "reference/interval_columns.h"
#include "reference/interval_search-inl.h"

LAMINA_SIMD_BEGIN
namespace reference {

class VisibleRanges {
  public:
    LAMINA_INLINE explicit VisibleRanges(const IntervalColumns& columns)
        : lo_(columns.visible_lo.data()),
          hi_(columns.visible_hi.data()),
          count_(columns.visible_count) {}

    LAMINA_INLINE DoubleMask meet(Double lo, Double hi) const {
        // Most functions have one.
        if (count_ <= 1) return (lo_[0] <= hi) & (lo <= hi_[0]);
        const Long below =
            count_first(hi_, count_, [&](Double end) LAMINA_LAMBDA { return end < lo; });
        return gather(lo_, below) <= hi;
    }

  private:
    const double *lo_, *hi_;
    std::size_t count_;
};

}  // namespace reference
LAMINA_SIMD_END

#endif
