// SPDX-License-Identifier: Apache-2.0
// Vectors of values and the intervals of a transfer function that they lie in.
#if defined(LAMINA_REFERENCE_INTERVAL_SEARCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_REFERENCE_INTERVAL_SEARCH_INL_H_
#undef LAMINA_REFERENCE_INTERVAL_SEARCH_INL_H_
#else
#define LAMINA_REFERENCE_INTERVAL_SEARCH_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>
#include <cstdint>
#include <vector>

#include "reference/cubic_lanes-inl.h"
#include "reference/interval_columns.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace reference {

HWY_INLINE Numbers where(Mask mask, Numbers yes, Numbers no) {
    return hn::IfThenElse(hn::RebindMask(NumberLanes(), mask), yes, no);
}

// Counts those of `count` ascending values for which is_passed(value) holds: the first ones. Behind
// them lies padding, at least up to a power of two.
template <typename Passed>
HWY_INLINE Numbers count_first(const double* values, std::size_t count, const Passed& is_passed) {
    // Up to this count a look at each value is quicker than the gathers of a binary search.
    constexpr std::size_t most_compared = 24;
    const NumberLanes n;
    Numbers passed = hn::Zero(n);
    if (count <= most_compared) {
        for (std::size_t i = 0; i < count; ++i) {
            const Mask one = is_passed(number(values[i]));
            passed = hn::Sub(passed, hn::VecFromMask(n, hn::RebindMask(n, one)));
        }
        return passed;
    }
    const Numbers one = hn::Set(n, 1), most = hn::Set(n, static_cast<std::int64_t>(count));
    for (auto step = static_cast<std::int64_t>(std::bit_ceil(count + 1) / 2); step > 0; step /= 2) {
        const Numbers next = hn::Add(passed, hn::Set(n, step));
        const Doubles last = hn::GatherIndex(Lanes(), values, hn::Sub(next, one));
        passed = where(is_passed(last), next, passed);
    }
    return hn::Min(passed, most);  // an infinite value passes padding, too
}

// Finds the intervals of values, and what columns have of intervals.
class IntervalSearch {
  public:
    HWY_INLINE explicit IntervalSearch(const IntervalColumns& columns)
        : columns_(columns),
          bounds_(columns.bounds.data()),
          in_a_vector_(columns.knot_count + 1 <= hn::Lanes(Lanes())) {}

    HWY_INLINE Doubles of(const std::vector<double>& column, Numbers interval) const {
        return look_up(column.data(), interval);
    }
    HWY_INLINE Doubles lower(Numbers interval) const { return look_up(bounds_, interval); }
    HWY_INLINE Doubles upper(Numbers interval) const { return look_up(bounds_ + 1, interval); }
    HWY_INLINE Mask shows(Numbers interval) const {
        return hn::Eq(of(columns_.transparent, interval), hn::Zero(Lanes()));
    }
    // The knot at which a scalar that rises, or falls, leaves the interval.
    HWY_INLINE Doubles knot_ahead(Numbers interval, Mask rises) const {
        return hn::IfThenElse(rises, upper(interval), lower(interval));
    }
    // The interval behind that knot.
    HWY_INLINE Numbers beyond(Numbers interval, Mask rises) const {
        const Numbers one = hn::Set(NumberLanes(), 1);
        return where(rises, hn::Add(interval, one), hn::Sub(interval, one));
    }
    // The interval for values at and above each value.
    HWY_INLINE Numbers above(Doubles value) const {
        return count_passed([&](Doubles knot) HWY_ATTR { return hn::Le(knot, value); });
    }

    // The interval for values at and above each value where the scalar rises from there; where it
    // falls, the one for values at and below.
    HWY_INLINE Numbers ahead(Doubles value, Mask rises) const {
        return count_passed([&](Doubles knot) HWY_ATTR { return passed(knot, value, rises); });
    }

    // The same, from an interval on that does not lie above it.
    HWY_INLINE Numbers onwards(Numbers interval, Doubles value, Mask rises) const {
        while (true) {
            const Mask further = passed(upper(interval), value, rises);
            if (hn::AllFalse(Lanes(), further)) return interval;
            interval = where(further, hn::Add(interval, hn::Set(NumberLanes(), 1)), interval);
        }
    }

  private:
    // A column that fits into a vector is looked up there, which is quicker than a gather.
    HWY_INLINE Doubles look_up(const double* column, Numbers interval) const {
        if (in_a_vector_)
            return hn::TableLookupLanes(hn::LoadU(Lanes(), column),
                                        hn::IndicesFromVec(Lanes(), interval));
        return hn::GatherIndex(Lanes(), column, interval);
    }

    template <typename Passed>
    HWY_INLINE Numbers count_passed(const Passed& is_passed) const {
        return count_first(bounds_ + 1, columns_.knot_count, is_passed);
    }

    HWY_INLINE static Mask passed(Doubles knot, Doubles value, Mask rises) {
        return hn::Or(hn::Lt(knot, value), hn::And(rises, hn::Eq(knot, value)));
    }

    const IntervalColumns& columns_;
    const double* bounds_;
    bool in_a_vector_;
};

}  // namespace reference
}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
