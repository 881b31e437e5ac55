// SPDX-License-Identifier: Apache-2.0
// Vector form of shaders/optics/piece_weights.glsl, which gives the reasons.
#if defined(LAMINA_TILES_PIECE_WEIGHTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_PIECE_WEIGHTS_INL_H_
#undef LAMINA_TILES_PIECE_WEIGHTS_INL_H_
#else
#define LAMINA_TILES_PIECE_WEIGHTS_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "tiles/arithmetic-inl.h"
#include "tiles/opacity-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The weight of the front's colour on a linear piece with extinction * length = p at its front and
// q at its back. It is computed by nine-point Gauss-Legendre quadrature on the stretch of optical
// depth below 12.
template <class D>
HWY_INLINE hn::Vec<D> piece_front_weight(D d, hn::Vec<D> p, hn::Vec<D> q) {
    using V = hn::Vec<D>;
    constexpr float nodes[] = {
        0.015919880246187f, 0.0819844463366821f, 0.193314283649705f,  0.337873288298096f, 0.5f,
        0.662126711701904f, 0.806685716350295f,  0.9180155536633179f, 0.984080119753813f};
    constexpr float weights[] = {0.0406371941807872f, 0.0903240803474287f, 0.130305348201468f,
                                 0.156173538520001f,  0.16511967750063f,   0.156173538520001f,
                                 0.130305348201468f,  0.0903240803474287f, 0.0406371941807872f};
    const V half = hn::Set(d, 0.5f), one = hn::Set(d, 1.0f), most_depth = hn::Set(d, 12.0f);
    const V depth = half * p + half * q;
    // The place where the optical depth in front of it is most_depth, in units of depth.
    const V slope = p / depth, share = most_depth / depth;
    const V twice = share + share;
    const V square = slope * slope + twice * (q / depth - slope);
    const V root = hn::Sqrt(hn::Max(square, hn::Zero(d)));
    const V place = twice / hn::Max(slope + root, hn::Set(d, 1e-18f));
    const V seen = hn::IfThenElse(hn::Gt(depth, most_depth), hn::Min(place, one), one);
    V sum = hn::Zero(d);
    for (std::size_t i = 0; i < std::size(nodes); ++i) {
        const V x = seen * hn::Set(d, nodes[i]), half_x = half * x;
        const V before = p * (one - half_x) + q * half_x;
        sum = mul_add(hn::Set(d, weights[i]), opacity_from_depth(d, x * before), sum);
    }
    return one - seen + seen * sum;
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
