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

// With so many terms, Taylor's series of (exp(-depth) - 1) / depth is good up to this depth: the
// remainder is below depth^(terms + 1) / (terms + 2)! = 7e-18, 1e-16 and 5e-16.
template <std::size_t terms>
inline constexpr double series_limit = terms == 6   ? 0.016
                                       : terms == 8 ? 0.09
                                                    : 0.25;

// (exp(-depth) - 1) / depth.
template <std::size_t terms>
HWY_INLINE Doubles short_expm1_share(Doubles depth) {
    static_assert(terms == 6 || terms == 8 || terms == 10, "series_limit");
    constexpr double inverse_factorials[] = {1. / 2,       1. / 6,       1. / 24,    1. / 120,
                                             1. / 720,     1. / 5040,    1. / 40320, 1. / 362880,
                                             1. / 3628800, 1. / 39916800};
    Doubles sum = number(inverse_factorials[terms - 1]);
    for (std::size_t i = terms - 1; i-- > 0;)
        sum = hn::NegMulAdd(depth, sum, number(inverse_factorials[i]));
    return hn::MulSub(depth, sum, number(1));
}

// exp(-depth) and 1 - exp(-depth) of any depths.
struct AnyDepth {
    HWY_INLINE Doubles exp(Doubles depth) const { return hn::Exp(Lanes(), hn::Neg(depth)); }
    HWY_INLINE Doubles opacity(Doubles depth) const {
        return hn::Neg(hn::Expm1(Lanes(), hn::Neg(depth)));
    }
};

// The same of depths up to series_limit<terms>.
template <std::size_t terms>
struct ShortDepth {
    HWY_INLINE Doubles exp(Doubles depth) const {
        return hn::MulAdd(depth, short_expm1_share<terms>(depth), number(1));
    }
    HWY_INLINE Doubles opacity(Doubles depth) const {
        return hn::Neg(hn::Mul(depth, short_expm1_share<terms>(depth)));
    }
};

// Depths up to this are short.
constexpr std::size_t most_terms = 10;
constexpr double short_depth = series_limit<most_terms>;

// The same of short depths in some lanes: each lane's result does not depend on the other lanes.
struct MixedDepth {
    Mask is_short;

    HWY_INLINE Doubles exp(Doubles depth) const {
        return hn::IfThenElse(is_short, ShortDepth<most_terms>().exp(depth), AnyDepth().exp(depth));
    }
    HWY_INLINE Doubles opacity(Doubles depth) const {
        return hn::IfThenElse(is_short, ShortDepth<most_terms>().opacity(depth),
                              AnyDepth().opacity(depth));
    }
};

}  // namespace reference
}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
