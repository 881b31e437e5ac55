// SPDX-License-Identifier: Apache-2.0
// Vector form of opacity_from_depth (optics/opacity.h), as in shaders/optics/opacity.glsl.
#if defined(LAMINA_TILES_OPACITY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_OPACITY_INL_H_
#undef LAMINA_TILES_OPACITY_INL_H_
#else
#define LAMINA_TILES_OPACITY_INL_H_
#endif

#include <hwy/highway.h>

#include "tiles/arithmetic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

// The opacity of an optical depth >= 0, with a relative error of 3e-7 at every depth, infinity
// included. The shader gives the reasons.
template <class D>
requires(sizeof(hn::TFromD<D>) == 4) HWY_INLINE hn::Vec<D> opacity_from_depth(D d,
                                                                              hn::Vec<D> depth) {
    const hn::RebindToSigned<D> di;
    const auto octaves =
        hn::Min(hn::Mul(depth, hn::Set(d, 1.4426950408889634f)), hn::Set(d, 126.0f));
    const auto n = hn::ConvertTo(di, hn::Add(octaves, hn::Set(d, 0.5f)));
    const auto f = hn::Sub(hn::ConvertTo(d, n), octaves);
    const auto power = hn::BitCast(d, hn::Sub(hn::Set(di, 0x3f800000), hn::ShiftLeft<23>(n)));
    constexpr float slope[] = {0.693147187926693f,     0.24022649794962264f,
                               0.0555035743364266f,    0.009618237494907015f,
                               0.0013390735477607873f, 0.00015403512367553545f};
    return hn::Sub(hn::Sub(hn::Set(d, 1.0f), power),
                   hn::Mul(power, hn::Mul(f, polynomial(d, f, slope))));
}

// The same in double precision, to 1e-13.
template <class D>
requires(sizeof(hn::TFromD<D>) == 8) HWY_INLINE hn::Vec<D> opacity_from_depth(D d,
                                                                              hn::Vec<D> depth) {
    const auto one = hn::Set(d, 1.0);
    const auto x = hn::Mul(hn::Min(depth, hn::Set(d, 40.0)), hn::Set(d, -1.0 / 256));
    auto sum = mul_add(x, hn::Set(d, 1.0 / 10), one);
    for (int i = 9; i >= 2; --i) sum = mul_add(hn::Mul(x, hn::Set(d, 1.0 / i)), sum, one);
    auto result = hn::Mul(x, sum);
    for (int i = 0; i < 8; ++i) result = hn::Mul(result, hn::Add(hn::Set(d, 2.0), result));
    return hn::Neg(result);
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
