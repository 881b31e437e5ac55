// SPDX-License-Identifier: Apache-2.0
// Vector form of DoubleDouble: the same numbers, rounded in the same way.
#if defined(LAMINA_REFERENCE_DOUBLE_DOUBLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_REFERENCE_DOUBLE_DOUBLES_INL_H_
#undef LAMINA_REFERENCE_DOUBLE_DOUBLES_INL_H_
#else
#define LAMINA_REFERENCE_DOUBLE_DOUBLES_INL_H_
#endif

#include <hwy/highway.h>

#include <cmath>

#include "reference/cubic_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace reference {

struct DoubleDoubles {
    Doubles hi, lo;

    HWY_INLINE Doubles rounded() const { return hn::Add(hi, lo); }
    HWY_INLINE Mask finite() const { return hn::And(hn::IsFinite(hi), hn::IsFinite(lo)); }
};

HWY_INLINE DoubleDoubles double_doubles(Doubles value) {
    return {value, hn::Zero(Lanes())};
}

HWY_INLINE DoubleDoubles exact_sum(Doubles a, Doubles b) {
    const Doubles sum = hn::Add(a, b);
    const Doubles b_part = hn::Sub(sum, a);
    return {sum, hn::Add(hn::Sub(a, hn::Sub(sum, b_part)), hn::Sub(b, b_part))};
}

HWY_INLINE DoubleDoubles exact_product(Doubles a, Doubles b) {
    const Doubles product = hn::Mul(a, b);
#if HWY_NATIVE_FMA
    return {product, hn::MulSub(a, b, product)};
#else
    alignas(64) double as[longest_vector], bs[longest_vector], rest[longest_vector];
    hn::Store(a, Lanes(), as);
    hn::Store(b, Lanes(), bs);
    hn::Store(product, Lanes(), rest);
    for (std::size_t lane = 0; lane < hn::Lanes(Lanes()); ++lane)
        rest[lane] = std::fma(as[lane], bs[lane], -rest[lane]);
    return {product, hn::Load(Lanes(), rest)};
#endif
}

HWY_INLINE DoubleDoubles operator-(DoubleDoubles a) {
    return {hn::Neg(a.hi), hn::Neg(a.lo)};
}

HWY_INLINE DoubleDoubles operator+(DoubleDoubles a, DoubleDoubles b) {
    const DoubleDoubles high = exact_sum(a.hi, b.hi);
    const DoubleDoubles low = exact_sum(a.lo, b.lo);
    const DoubleDoubles middle = exact_sum(high.hi, hn::Add(high.lo, low.hi));
    return exact_sum(middle.hi, hn::Add(middle.lo, low.lo));
}

HWY_INLINE DoubleDoubles operator-(DoubleDoubles a, DoubleDoubles b) {
    return a + -b;
}

HWY_INLINE DoubleDoubles operator*(DoubleDoubles a, DoubleDoubles b) {
    const DoubleDoubles product = exact_product(a.hi, b.hi);
    const Doubles rest = hn::Add(hn::Mul(a.hi, b.lo), hn::Mul(a.lo, b.hi));
    return exact_sum(product.hi, hn::Add(product.lo, rest));
}

HWY_INLINE DoubleDoubles operator/(DoubleDoubles a, DoubleDoubles b) {
    const Doubles first = hn::Div(a.hi, b.hi);
    const DoubleDoubles rest = a - b * double_doubles(first);
    const Doubles second = hn::Div(rest.hi, b.hi);
    const Doubles third = hn::Div((rest - b * double_doubles(second)).hi, b.hi);
    return exact_sum(first, second) + double_doubles(third);
}

HWY_INLINE Mask operator<(DoubleDoubles a, DoubleDoubles b) {
    return hn::Or(hn::Lt(a.hi, b.hi), hn::And(hn::Eq(a.hi, b.hi), hn::Lt(a.lo, b.lo)));
}

HWY_INLINE DoubleDoubles where(Mask mask, DoubleDoubles yes, DoubleDoubles no) {
    return {hn::IfThenElse(mask, yes.hi, no.hi), hn::IfThenElse(mask, yes.lo, no.lo)};
}

}  // namespace reference
}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
