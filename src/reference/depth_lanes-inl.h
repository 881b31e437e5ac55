// SPDX-License-Identifier: Apache-2.0
// Transmittance and opacity of vectors of optical depths.
#if defined(LAMINA_REFERENCE_DEPTH_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_REFERENCE_DEPTH_LANES_INL_H_
#undef LAMINA_REFERENCE_DEPTH_LANES_INL_H_
#else
#define LAMINA_REFERENCE_DEPTH_LANES_INL_H_
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "reference/cubic_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace reference {

// Up to this depth exp(-depth) is summed by Taylor's series.
constexpr double short_depth = 0.25;

// (exp(-depth) - 1) / depth, short_depth at most. The series' remainder is below depth^11 / 12! =
// 5e-16.
HWY_INLINE Doubles short_expm1_share(Doubles depth) {
    constexpr double inverse_factorials[] = {1. / 2,       1. / 6,       1. / 24,    1. / 120,
                                             1. / 720,     1. / 5040,    1. / 40320, 1. / 362880,
                                             1. / 3628800, 1. / 39916800};
    Doubles sum = number(inverse_factorials[9]);
    for (int i = 9; i-- > 0;) sum = hn::NegMulAdd(depth, sum, number(inverse_factorials[i]));
    return hn::MulSub(depth, sum, number(1));
}

// How exp() is computed.
struct AnyDepth {
    HWY_INLINE static Doubles exp(Doubles depth) { return hn::Exp(Lanes(), hn::Neg(depth)); }
    HWY_INLINE static Doubles opacity(Doubles depth) {
        return hn::Neg(hn::Expm1(Lanes(), hn::Neg(depth)));
    }
};
struct ShortDepth {
    HWY_INLINE static Doubles exp(Doubles depth) {
        return hn::MulAdd(depth, short_expm1_share(depth), number(1));
    }
    HWY_INLINE static Doubles opacity(Doubles depth) {
        return hn::Neg(hn::Mul(depth, short_expm1_share(depth)));
    }
};

}  // namespace reference
}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
