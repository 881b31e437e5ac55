// SPDX-License-Identifier: Apache-2.0
// Vectors of doubles, and of cubics. Vector forms of cubic.h.
#if defined(LAMINA_REFERENCE_CUBIC_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_REFERENCE_CUBIC_LANES_INL_H_
#undef LAMINA_REFERENCE_CUBIC_LANES_INL_H_
#else
#define LAMINA_REFERENCE_CUBIC_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "base/set_members.h"
#include "reference/cubic.h"
#include "reference/lane_set.h"
#include "reference/longest_vector.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace reference {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::ScalableTag<double>;
static_assert(HWY_MAX_BYTES <= longest_vector * sizeof(double));
using Doubles = hn::Vec<Lanes>;
using Mask = hn::Mask<Lanes>;
using NumberLanes = hn::ScalableTag<std::int64_t>;
using Numbers = hn::Vec<NumberLanes>;

HWY_INLINE Doubles number(double value) {
    return hn::Set(Lanes(), value);
}

HWY_INLINE LaneSet set_of(Mask lanes) {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(Lanes(), lanes, bits);
    return bits[0];
}

// Stores some lanes of vectors one after the other, for which it writes whole vectors.
class KeptLanes {
  public:
    HWY_INLINE explicit KeptLanes(Mask kept)
        : kept_(places(kept)), count_(hn::CountTrue(Lanes(), kept)) {}

    HWY_INLINE std::size_t count() const { return count_; }
    HWY_INLINE void store(Doubles values, double* to) const {
        hn::StoreU(hn::TableLookupLanes(values, kept_), Lanes(), to);
    }
    HWY_INLINE void store(Numbers values, std::int64_t* to) const {
        const Doubles bits = hn::TableLookupLanes(hn::BitCast(Lanes(), values), kept_);
        hn::StoreU(hn::BitCast(NumberLanes(), bits), NumberLanes(), to);
    }

  private:
    using Places = decltype(hn::IndicesFromVec(Lanes(), Numbers()));

    static HWY_INLINE Places places(Mask kept) {
        const NumberLanes n;
        const hn::RebindToUnsigned<NumberLanes> u;
        const auto shift = hn::ShiftLeft<3>(hn::Iota(u, 0));
        const auto places =
            hn::And(hn::Shr(hn::Set(u, members_of[set_of(kept)]), shift), hn::Set(u, 7));
        return hn::IndicesFromVec(Lanes(), hn::BitCast(n, places));
    }

    Places kept_;
    std::size_t count_;
};

struct Cubics {
    Doubles c[4];

    HWY_INLINE Doubles at(Doubles t) const {
        return hn::MulAdd(hn::MulAdd(hn::MulAdd(c[3], t, c[2]), t, c[1]), t, c[0]);
    }
    HWY_INLINE Doubles slope(Doubles t) const {
        const Doubles end = hn::MulAdd(hn::Mul(number(3), c[3]), t, hn::Mul(number(2), c[2]));
        return hn::MulAdd(end, t, c[1]);
    }
    HWY_INLINE Mask constant() const {
        const Doubles zero = hn::Zero(Lanes());
        return hn::And(hn::Eq(c[1], zero), hn::And(hn::Eq(c[2], zero), hn::Eq(c[3], zero)));
    }
};

// Where cubics turn, 0 < first < second < 1; 1 where they do not.
struct Turns {
    Doubles first, second;
};

HWY_INLINE Turns turns_of(const Cubics& cubics) {
    const Lanes d;
    const Doubles zero = hn::Zero(d), one = number(1);
    Doubles a = hn::Mul(number(3), cubics.c[3]), b = cubics.c[2], c = cubics.c[1];
    const Doubles largest = hn::Max(hn::Abs(a), hn::Max(hn::Abs(b), hn::Abs(c)));
    a = hn::Div(a, largest);
    b = hn::Div(b, largest);
    c = hn::Div(c, largest);
    const Doubles discriminant = hn::MulSub(b, b, hn::Mul(a, c));
    const Mask real = hn::Gt(discriminant, zero);
    const Doubles root = hn::Sqrt(hn::IfThenElseZero(real, discriminant));
    const Doubles q = hn::Neg(hn::Add(b, hn::CopySign(root, b)));
    // Infinite, or no number, where there is no second power: not kept.
    const auto inside = [&](Doubles at) HWY_ATTR {
        const Mask kept = hn::And(real, hn::And(hn::Gt(at, zero), hn::Lt(at, one)));
        return hn::IfThenElse(kept, at, one);
    };
    const Doubles x = inside(hn::Div(q, a)), y = inside(hn::Div(c, q));
    const Doubles first = hn::Min(x, y), second = hn::Max(x, y);
    return {first, hn::IfThenElse(hn::Gt(second, first), second, one)};
}

// As solve_monotone(), of the lanes in `wanted`.
HWY_INLINE Doubles solve_monotone(const Cubics& cubics, Doubles value, Doubles from, Doubles to,
                                  Mask wanted) {
    const Lanes d;
    const Doubles half = number(0.5), zero = hn::Zero(d);
    Cubics shifted = cubics;
    shifted.c[0] = hn::Sub(cubics.c[0], value);
    const Doubles at_from = shifted.at(from), at_to = shifted.at(to);
    const Mask falls = hn::Gt(at_from, at_to);
    Doubles below = hn::IfThenElse(falls, to, from), above = hn::IfThenElse(falls, from, to);
    Doubles step = hn::Abs(hn::Sub(to, from)), previous_step = step;
    Doubles t = hn::MulAdd(hn::Sub(to, from), hn::Div(at_from, hn::Sub(at_from, at_to)), from);
    const Mask between = hn::And(hn::Gt(t, from), hn::Lt(t, to));
    t = hn::IfThenElse(between, t, hn::Mul(half, hn::Add(from, to)));
    const Doubles bend = hn::MulAdd(number(3), hn::Abs(cubics.c[3]), hn::Abs(cubics.c[2]));
    Mask done = hn::Not(wanted);
    for (int i = 0; i < most_newton_steps && !hn::AllTrue(d, done); ++i) {
        const Doubles f = shifted.at(t), slope = shifted.slope(t);
        done = hn::Or(done, hn::Eq(f, zero));
        const Mask negative = hn::Lt(f, zero);
        below = hn::IfThenElse(hn::AndNot(done, negative), t, below);
        above = hn::IfThenElse(hn::Or(done, negative), above, t);
        const Doubles newton = hn::Sub(t, hn::Div(f, slope));
        const Mask inside =
            hn::And(hn::Gt(newton, hn::Min(below, above)), hn::Lt(newton, hn::Max(below, above)));
        const Mask fast = hn::Le(hn::Abs(hn::Add(f, f)), hn::Abs(hn::Mul(previous_step, slope)));
        const Mask by_newton = hn::And(inside, fast);
        const Doubles next =
            hn::IfThenElse(by_newton, newton, hn::Mul(half, hn::Add(below, above)));
        previous_step = step;
        step = hn::Abs(hn::Sub(next, t));
        t = hn::IfThenElse(done, t, next);
        const Doubles rounding = hn::Mul(number(root_precision), hn::Abs(t));
        const Doubles bent = hn::Mul(hn::Div(bend, hn::Abs(slope)), step);
        const Mask straight = hn::And(hn::Le(hn::Mul(bent, step), rounding),
                                      hn::Le(hn::Mul(number(8), bent), number(1)));
        done = hn::Or(done, hn::Or(hn::Le(step, rounding), hn::And(by_newton, straight)));
    }
    return t;
}

// As part_of().
HWY_INLINE Cubics part_of(const Cubics& cubics, Doubles from, Doubles to, Doubles start,
                          Doubles end) {
    const Doubles h = hn::Sub(to, from), h2 = hn::Mul(h, h);
    Cubics part;
    part.c[0] = start;
    part.c[1] = hn::Mul(cubics.slope(from), h);
    part.c[2] = hn::Mul(hn::MulAdd(hn::Mul(number(3), cubics.c[3]), from, cubics.c[2]), h2);
    part.c[3] = hn::Mul(cubics.c[3], hn::Mul(h2, h));
    const Doubles sum = hn::Add(part.c[1], hn::Add(part.c[2], part.c[3]));
    part.c[1] = hn::Add(part.c[1], hn::Sub(hn::Sub(end, start), sum));
    return part;
}

}  // namespace reference
}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
