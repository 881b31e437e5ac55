// SPDX-License-Identifier: Apache-2.0
// Vectors of floats with operators, for formulas.
#if defined(LAMINA_EXECUTORS_TILE_NUMBER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_EXECUTORS_TILE_NUMBER_INL_H_
#undef LAMINA_EXECUTORS_TILE_NUMBER_INL_H_
#else
#define LAMINA_EXECUTORS_TILE_NUMBER_INL_H_
#endif

#include <hwy/highway.h>

#include "executors/tile_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

// One number for each lane. As everywhere, products and sums are rounded one by one.
struct Number {
    Floats v;

    Number() = default;
    HWY_INLINE Number(Floats lanes) : v(lanes) {}
    HWY_INLINE Number(float all) : v(hn::Set(FloatTag(), all)) {}
};

HWY_INLINE Number operator+(Number a, Number b) {
    return hn::Add(a.v, b.v);
}
HWY_INLINE Number operator-(Number a, Number b) {
    return hn::Sub(a.v, b.v);
}
HWY_INLINE Number operator*(Number a, Number b) {
    return hn::Mul(a.v, b.v);
}
HWY_INLINE Number operator/(Number a, Number b) {
    return hn::Div(a.v, b.v);
}
HWY_INLINE FloatMask operator<(Number a, Number b) {
    return hn::Lt(a.v, b.v);
}
HWY_INLINE FloatMask operator>(Number a, Number b) {
    return hn::Gt(a.v, b.v);
}
HWY_INLINE FloatMask operator<=(Number a, Number b) {
    return hn::Le(a.v, b.v);
}
HWY_INLINE FloatMask operator>=(Number a, Number b) {
    return hn::Ge(a.v, b.v);
}
HWY_INLINE FloatMask operator==(Number a, Number b) {
    return hn::Eq(a.v, b.v);
}
HWY_INLINE Number min(Number a, Number b) {
    return hn::Min(a.v, b.v);
}
HWY_INLINE Number max(Number a, Number b) {
    return hn::Max(a.v, b.v);
}
HWY_INLINE Number select(FloatMask mask, Number yes, Number no) {
    return hn::IfThenElse(mask, yes.v, no.v);
}
HWY_INLINE Number zero_unless(FloatMask mask, Number a) {
    return hn::IfThenElseZero(mask, a.v);
}
HWY_INLINE Number load_number(const float* from) {
    return hn::Load(FloatTag(), from);
}
HWY_INLINE void store_number(Number a, float* to) {
    hn::Store(a.v, FloatTag(), to);
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
