// SPDX-License-Identifier: Apache-2.0
// Transmittance and opacity of vectors of optical depths.
#if defined(LAMINA_REFERENCE_DEPTH_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_REFERENCE_DEPTH_LANES_INL_H_
#undef LAMINA_REFERENCE_DEPTH_LANES_INL_H_
#else
#define LAMINA_REFERENCE_DEPTH_LANES_INL_H_
#endif

#include "simd/math-inl.h"

LAMINA_SIMD_BEGIN
namespace reference {

// With so many terms, Taylor's series of (exp(-depth) - 1) / depth is good up to this depth: the
// remainder is below depth^(terms + 1) / (terms + 2)! = 7e-18, 1e-16 and 5e-16.
template <std::size_t terms>
inline constexpr double series_limit = terms == 6   ? 0.016
                                       : terms == 8 ? 0.09
                                                    : 0.25;

// (exp(-depth) - 1) / depth.
template <std::size_t terms>
LAMINA_INLINE Double short_expm1_share(Double depth) {
    static_assert(terms == 6 || terms == 8 || terms == 10, "series_limit");
    constexpr double inverse_factorials[] = {1. / 2,       1. / 6,       1. / 24,    1. / 120,
                                             1. / 720,     1. / 5040,    1. / 40320, 1. / 362880,
                                             1. / 3628800, 1. / 39916800};
    Double sum = inverse_factorials[terms - 1];
    for (std::size_t i = terms - 1; i-- > 0;) sum = fnma(depth, sum, inverse_factorials[i]);
    return fms(depth, sum, 1);
}

// Transmittance exp(-depth) and opacity 1 - exp(-depth) of any depths.
struct AnyDepth {
    LAMINA_INLINE Double transmittance(Double depth) const { return exp(-depth); }
    LAMINA_INLINE Double opacity(Double depth) const { return -expm1(-depth); }
};

// The same of depths up to series_limit<terms>.
template <std::size_t terms>
struct ShortDepth {
    LAMINA_INLINE Double transmittance(Double depth) const {
        return fma(depth, short_expm1_share<terms>(depth), 1);
    }
    LAMINA_INLINE Double opacity(Double depth) const {
        return -(depth * short_expm1_share<terms>(depth));
    }
};

// Depths up to this are short.
constexpr std::size_t most_terms = 10;
constexpr double short_depth = series_limit<most_terms>;

// The same of short depths in some lanes: each lane's result does not depend on the other lanes.
struct MixedDepth {
    DoubleMask is_short;

    LAMINA_INLINE Double transmittance(Double depth) const {
        return select(is_short, ShortDepth<most_terms>().transmittance(depth),
                      AnyDepth().transmittance(depth));
    }
    LAMINA_INLINE Double opacity(Double depth) const {
        return select(is_short, ShortDepth<most_terms>().opacity(depth), AnyDepth().opacity(depth));
    }
};

}  // namespace reference
LAMINA_SIMD_END

#endif
