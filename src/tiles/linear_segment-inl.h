// SPDX-License-Identifier: Apache-2.0
// Vector form of shaders/optics/linear_segment.glsl: a segment on which colour and extinction are
// linear. Opacity has a closed form; colour needs the weight of the segment's front
// (optics/front_weights.h).
#if defined(LAMINA_TILES_LINEAR_SEGMENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_LINEAR_SEGMENT_INL_H_
#undef LAMINA_TILES_LINEAR_SEGMENT_INL_H_
#else
#define LAMINA_TILES_LINEAR_SEGMENT_INL_H_
#endif

#include <hwy/highway.h>

#include "optics/front_weights.h"
#include "tiles/arithmetic-inl.h"
#include "tiles/opacity-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// For optical depths up to faint_depth. Opacity has a relative error of 1.1e-7, and the weight is
// that of faint_front_weight().
template <class D>
HWY_INLINE hn::Vec<D> faint_opacity(D d, hn::Vec<D> depth) {
    return depth * polynomial(d, depth, {0.9999999f, -0.4999845f, 0.16627573f, -0.03848669f});
}
template <class D>
HWY_INLINE hn::Vec<D> faint_front_weight(D d, hn::Vec<D> p, hn::Vec<D> q) {
    const auto set = [d](float c) HWY_ATTR { return hn::Set(d, c); };
    const auto pq = set(-0.07483143f) + p * set(0.01593537f) + q * set(0.01098378f);
    const auto of_p = set(0.33332185f) + p * (set(-0.06649057f) + p * set(0.00875053f)) + q * pq;
    const auto of_q = set(0.166663f) + q * (set(-0.02493882f) + q * set(0.00273092f));
    return p * of_p + q * of_q;
}

// For optical depths up to thin_depth.
template <class D>
HWY_INLINE hn::Vec<D> thin_front_weight(D d, hn::Vec<D> p, hn::Vec<D> q) {
    const auto c0 =
        q * polynomial(d, q, {0.166777794f, -0.025093103f, 0.002890381f, -0.000196459f});
    const auto c1 = polynomial(d, q, {0.333037217f, -0.074477034f, 0.011162302f, -0.000919007f});
    const auto c2 = polynomial(d, q, {-0.065656503f, 0.015676728f, -0.001696676f});
    const auto c3 = polynomial(d, q, {0.008428908f, -0.001502640f});
    const auto c4 = hn::Set(d, -0.000561545f);
    return mul_add(p, mul_add(p, mul_add(p, mul_add(p, c4, c3), c2), c1), c0);
}

// `table`: the texels of FrontWeightTable, nodes x nodes floats, one row for each q.
template <class D>
HWY_INLINE hn::Vec<D> front_weight(D d, const float* table, int nodes, hn::Vec<D> p, hn::Vec<D> q) {
    const hn::RebindToSigned<D> di;
    const auto one = hn::Set(d, 1.0f), last = hn::Set(d, static_cast<float>(nodes - 1));
    const auto finite = hn::Set(d, 1e30f);
    p = hn::Min(p, finite);
    q = hn::Min(q, finite);
    // 1 - 1 / (1 + p) and 1 - 1 / sqrt(1 + q), computed without a difference so that segments of
    // small optical depth keep their digits.
    const auto root = hn::Sqrt(one + q);
    const auto x = last * (p / (one + p));
    const auto y = last * (q / root / (one + root));
    const auto most = hn::Set(di, nodes - 2);
    const auto column = hn::Min(hn::ConvertTo(di, x), most),
               row = hn::Min(hn::ConvertTo(di, y), most);
    const auto share_x = x - hn::ConvertTo(d, column), share_y = y - hn::ConvertTo(d, row);
    const auto place = row * hn::Set(di, nodes) + column;
    const auto near =
        mix(hn::GatherIndex(d, table, place), hn::GatherIndex(d, table + 1, place), share_x);
    const auto far = mix(hn::GatherIndex(d, table + nodes, place),
                         hn::GatherIndex(d, table + nodes + 1, place), share_x);
    return mix(near, far, share_y);
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
