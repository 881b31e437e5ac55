// SPDX-License-Identifier: Apache-2.0
// Vectors of values and the intervals of a transfer function that they lie in.
#if defined(LAMINA_REFERENCE_TRANSFER_INTERVALS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_REFERENCE_TRANSFER_INTERVALS_INL_H_
#undef LAMINA_REFERENCE_TRANSFER_INTERVALS_INL_H_
#else
#define LAMINA_REFERENCE_TRANSFER_INTERVALS_INL_H_
#endif

#include <bit>
#include <cstdint>
#include <vector>

#include "reference/transfer_intervals.h"
#include "simd/vectors-inl.h"

LAMINA_SIMD_BEGIN
namespace reference {

// Counts those of `count` ascending values for which is_passed(value) holds: the first ones. Behind
// them lies padding, at least up to a power of two.
template <typename Passed>
LAMINA_INLINE Long count_first(const double* values, std::size_t count, const Passed& is_passed) {
    // Largest count up to which comparing each value is quicker than the gathers of a binary
    // search.
    constexpr std::size_t most_compared = 24;
    Long passed(0);
    if (count <= most_compared) {
        for (std::size_t i = 0; i < count; ++i) {
            passed -= minus_one_in(is_passed(Double(values[i])));
        }
        return passed;
    }
    for (auto step = static_cast<std::int64_t>(std::bit_ceil(count + 1) / 2); step > 0; step /= 2) {
        const Long next = passed + step;
        const Double last = gather(values, next - 1);
        passed = select(is_passed(last), next, passed);
    }
    return min(passed, static_cast<std::int64_t>(count));  // an infinite value passes padding, too
}

// Finds the intervals of values, and the values of columns for intervals.
class IntervalSearch {
  public:
    LAMINA_INLINE explicit IntervalSearch(const IntervalColumns& columns)
        : columns_(columns),
          bounds_(columns.bounds.data()),
          in_a_vector_(columns.knot_count + 1 <= Double::lanes) {}

    LAMINA_INLINE Double of(const std::vector<double>& column, Long interval) const {
        return look_up(column.data(), interval);
    }
    LAMINA_INLINE Double lower(Long interval) const { return look_up(bounds_, interval); }
    LAMINA_INLINE Double upper(Long interval) const { return look_up(bounds_ + 1, interval); }
    LAMINA_INLINE DoubleMask shows(Long interval) const {
        return of(columns_.transparent, interval) == 0;
    }
    // Returns the knot at which a scalar that rises, or falls, leaves the interval.
    LAMINA_INLINE Double knot_ahead(Long interval, DoubleMask rises) const {
        return select(rises, upper(interval), lower(interval));
    }
    // Returns the interval behind that knot.
    LAMINA_INLINE Long beyond(Long interval, DoubleMask rises) const {
        return select(rises, interval + 1, interval - 1);
    }
    // Returns the interval for values at and above each value.
    LAMINA_INLINE Long above(Double value) const {
        return count_passed([&](Double knot) LAMINA_LAMBDA { return knot <= value; });
    }

    // Returns the interval for values at and above each value in lanes in which the scalar rises
    // from there; in others the one for values at and below.
    LAMINA_INLINE Long ahead(Double value, DoubleMask rises) const {
        return count_passed([&](Double knot) LAMINA_LAMBDA { return passed(knot, value, rises); });
    }

    // Does the same from an interval on that does not lie above it.
    LAMINA_INLINE Long onwards(Long interval, Double value, DoubleMask rises) const {
        while (true) {
            const DoubleMask further = passed(upper(interval), value, rises);
            if (none_of(further)) return interval;
            interval = select(further, interval + 1, interval);
        }
    }

  private:
    // A column that fits into a vector is looked up there, which is quicker than a gather.
    LAMINA_INLINE Double look_up(const double* column, Long interval) const {
        if (in_a_vector_) return permute(load_unaligned<Double>(column), interval);
        return gather(column, interval);
    }

    template <typename Passed>
    LAMINA_INLINE Long count_passed(const Passed& is_passed) const {
        return count_first(bounds_ + 1, columns_.knot_count, is_passed);
    }

    LAMINA_INLINE static DoubleMask passed(Double knot, Double value, DoubleMask rises) {
        return (knot < value) | (rises & (knot == value));
    }

    const IntervalColumns& columns_;
    const double* bounds_;
    bool in_a_vector_;
};

// Finds ranges of values that may be visible: TransferIntervals::visible() of vectors.
class VisibleRanges {
  public:
    LAMINA_INLINE explicit VisibleRanges(const IntervalColumns& columns)
        : lo_(columns.visible_lo.data()),
          hi_(columns.visible_hi.data()),
          count_(columns.visible_count) {}

    LAMINA_INLINE DoubleMask meet(Double lo, Double hi) const {
        // Most functions have a single range.
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
