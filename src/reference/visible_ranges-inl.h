// SPDX-License-Identifier: Apache-2.0
// Vector form of TransferIntervals::visible().
#if defined(LAMINA_REFERENCE_VISIBLE_RANGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_REFERENCE_VISIBLE_RANGES_INL_H_
#undef LAMINA_REFERENCE_VISIBLE_RANGES_INL_H_
#else
#define LAMINA_REFERENCE_VISIBLE_RANGES_INL_H_
#endif

#include <hwy/highway.h>

#include "reference/interval_columns.h"
#include "reference/interval_search-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace reference {

class VisibleRanges {
  public:
    HWY_INLINE explicit VisibleRanges(const IntervalColumns& columns)
        : lo_(columns.visible_lo.data()),
          hi_(columns.visible_hi.data()),
          count_(columns.visible_count) {}

    HWY_INLINE Mask meet(Doubles lo, Doubles hi) const {
        // Most functions have one.
        if (count_ <= 1) return hn::And(hn::Le(number(lo_[0]), hi), hn::Le(lo, number(hi_[0])));
        const Numbers below =
            count_first(hi_, count_, [&](Doubles end) HWY_ATTR { return hn::Lt(end, lo); });
        return hn::Le(hn::GatherIndex(Lanes(), lo_, below), hi);
    }

  private:
    const double *lo_, *hi_;
    std::size_t count_;
};

}  // namespace reference
}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
