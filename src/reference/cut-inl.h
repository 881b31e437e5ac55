// SPDX-License-Identifier: Apache-2.0
// SIMD versions of cut.h's functions on cubics, one a lane, and searches for a value's interval.
#if defined(LAMINA_REFERENCE_CUT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_REFERENCE_CUT_INL_H_
#undef LAMINA_REFERENCE_CUT_INL_H_
#else
#define LAMINA_REFERENCE_CUT_INL_H_
#endif

#include <bit>

#include "reference/cut.h"
#include "simd/vectors-inl.h"

LAMINA_SIMD_BEGIN
namespace reference {

struct Cubics {
    Double c[4];

    LAMINA_INLINE Double at(Double t) const {
        return fma(fma(fma(c[3], t, c[2]), t, c[1]), t, c[0]);
    }
    LAMINA_INLINE Double slope(Double t) const {
        const Double end = fma(3 * c[3], t, 2 * c[2]);
        return fma(end, t, c[1]);
    }
    LAMINA_INLINE DoubleMask constant() const { return (c[1] == 0) & ((c[2] == 0) & (c[3] == 0)); }
};

// The t at which cubics turn, 0 < first < second < 1; 1 for each that does not exist.
struct Turns {
    Double first, second;
};

LAMINA_INLINE Turns turns_of(const Cubics& cubics) {
    Double a = 3 * cubics.c[3], b = cubics.c[2], c = cubics.c[1];
    const Double largest = max(abs(a), max(abs(b), abs(c)));
    a = a / largest;
    b = b / largest;
    c = c / largest;
    const Double discriminant = fms(b, b, a * c);
    const DoubleMask real = discriminant > 0;
    const Double root = sqrt(zero_unless(real, discriminant));
    const Double q = -(b + copy_sign(root, b));
    // If the derivative has no second power, a root is infinite or NaN, and not kept.
    const auto inside = [&](Double at) LAMINA_LAMBDA {
        const DoubleMask kept = real & ((at > 0) & (at < 1));
        return select(kept, at, 1);
    };
    const Double x = inside(q / a), y = inside(c / q);
    const Double first = min(x, y), second = max(x, y);
    return {first, select(second > first, second, 1)};
}

LAMINA_INLINE Double solve_monotone(const Cubics& cubics, Double value, Double from, Double to,
                                    DoubleMask wanted) {
    Cubics shifted = cubics;
    shifted.c[0] = cubics.c[0] - value;
    const Double at_from = shifted.at(from), at_to = shifted.at(to);
    const DoubleMask falls = at_from > at_to;
    Double below = select(falls, to, from), above = select(falls, from, to);
    Double step = abs(to - from), previous_step = step;
    Double t = fma(to - from, at_from / (at_from - at_to), from);
    const DoubleMask between = (t > from) & (t < to);
    t = select(between, t, 0.5 * (from + to));
    const Double bend = fma(3, abs(cubics.c[3]), abs(cubics.c[2]));
    DoubleMask done = !wanted;
    for (int i = 0; i < most_newton_steps && !all_of(done); ++i) {
        const Double f = shifted.at(t), slope = shifted.slope(t);
        done = done | (f == 0);
        const DoubleMask negative = f < 0;
        below = select(without(negative, done), t, below);
        above = select(done | negative, above, t);
        const Double newton = t - f / slope;
        const DoubleMask inside = (newton > min(below, above)) & (newton < max(below, above));
        const DoubleMask fast = abs(f + f) <= abs(previous_step * slope);
        const DoubleMask by_newton = inside & fast;
        const Double next = select(by_newton, newton, 0.5 * (below + above));
        previous_step = step;
        step = abs(next - t);
        t = select(done, t, next);
        const Double rounding = root_precision * abs(t);
        const Double bent = bend / abs(slope) * step;
        const DoubleMask straight = (bent * step <= rounding) & (8 * bent <= 1);
        done = done | ((step <= rounding) | (by_newton & straight));
    }
    return t;
}

LAMINA_INLINE Cubics restricted(const Cubics& cubics, Double from, Double to, Double start,
                                Double end) {
    const Double h = to - from, h2 = h * h;
    Cubics inside;
    inside.c[0] = start;
    inside.c[1] = cubics.slope(from) * h;
    inside.c[2] = fma(3 * cubics.c[3], from, cubics.c[2]) * h2;
    inside.c[3] = cubics.c[3] * (h2 * h);
    const Double sum = inside.c[1] + (inside.c[2] + inside.c[3]);
    inside.c[1] += end - start - sum;
    return inside;
}

// Counts the leading values, of `count` ascending ones, for which is_passed(value) holds. The array
// must be padded with infinity, at least to a power of two.
template <typename Passed>
LAMINA_INLINE Long count_first(const double* values, std::size_t count, const Passed& is_passed) {
    // Up to this count comparing each value is quicker than a binary search.
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
    // If the searched value is infinite, it passes the padding, too.
    return min(passed, static_cast<std::int64_t>(count));
}

// Finds the interval of a value, and looks up its properties, in vectors.
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
    LAMINA_INLINE Long beyond(Long interval, DoubleMask rises) const {
        return select(rises, interval + 1, interval - 1);
    }
    // Returns the interval that holds each value and what lies just above it.
    LAMINA_INLINE Long above(Double value) const {
        return count_passed([&](Double knot) LAMINA_LAMBDA { return knot <= value; });
    }

    // Returns the interval into which the scalar goes: above the value if it rises, else below.
    LAMINA_INLINE Long ahead(Double value, DoubleMask rises) const {
        return count_passed([&](Double knot) LAMINA_LAMBDA { return passed(knot, value, rises); });
    }

    // Does what ahead() does, searching up from `interval`, which is not above the result.
    LAMINA_INLINE Long onwards(Long interval, Double value, DoubleMask rises) const {
        while (true) {
            const DoubleMask further = passed(upper(interval), value, rises);
            if (none_of(further)) return interval;
            interval = select(further, interval + 1, interval);
        }
    }

  private:
    // Looks up a column that fits into a vector by a permutation, which is quicker than a gather.
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

// Vectors' form of TransferIntervals::visible(): finds whether ranges of values may be visible.
class VisibleRanges {
  public:
    LAMINA_INLINE explicit VisibleRanges(const IntervalColumns& columns)
        : lo_(columns.visible_lo.data()),
          hi_(columns.visible_hi.data()),
          count_(columns.visible_count) {}

    LAMINA_INLINE DoubleMask meet(Double lo, Double hi) const {
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
