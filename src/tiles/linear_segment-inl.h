// SPDX-License-Identifier: Apache-2.0
// Vector form of shaders/optics/linear_segment.glsl: a segment on which colour and extinction are
// linear. Opacity has a closed form; colour needs the weight of the segment's front
// (optics/segment_integral.h).
#if defined(LAMINA_TILES_LINEAR_SEGMENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_LINEAR_SEGMENT_INL_H_
#undef LAMINA_TILES_LINEAR_SEGMENT_INL_H_
#else
#define LAMINA_TILES_LINEAR_SEGMENT_INL_H_
#endif

#include "optics/segment_integral.h"
#include "tiles/opacity-inl.h"

LAMINA_SIMD_BEGIN

// For optical depths up to faint_depth. Opacity has a relative error of 1.1e-7, and the weight is
// that of faint_front_weight().
LAMINA_INLINE Float faint_opacity(Float depth) {
    return depth * polynomial(depth, {0.9999999f, -0.4999845f, 0.16627573f, -0.03848669f});
}
LAMINA_INLINE Float faint_front_weight(Float p, Float q) {
    const Float pq = -0.07483143f + p * 0.01593537f + q * 0.01098378f;
    const Float of_p = 0.33332185f + p * (-0.06649057f + p * 0.00875053f) + q * pq;
    const Float of_q = 0.166663f + q * (-0.02493882f + q * 0.00273092f);
    return p * of_p + q * of_q;
}

// For optical depths up to thin_depth.
LAMINA_INLINE Float thin_front_weight(Float p, Float q) {
    const Float c0 = q * polynomial(q, {0.166777794f, -0.025093103f, 0.002890381f, -0.000196459f});
    const Float c1 = polynomial(q, {0.333037217f, -0.074477034f, 0.011162302f, -0.000919007f});
    const Float c2 = polynomial(q, {-0.065656503f, 0.015676728f, -0.001696676f});
    const Float c3 = polynomial(q, {0.008428908f, -0.001502640f});
    constexpr float c4 = -0.000561545f;
    return p * (p * (p * (p * c4 + c3) + c2) + c1) + c0;
}

// `table`: the texels of FrontWeightTable, nodes x nodes floats, one row for each q.
LAMINA_INLINE Float front_weight(const float* table, int nodes, Float p, Float q) {
    constexpr float finite = 1e30f;
    const auto last = static_cast<float>(nodes - 1);
    p = min(p, finite);
    q = min(q, finite);
    // 1 - 1 / (1 + p) and 1 - 1 / sqrt(1 + q), computed without a difference so that segments of
    // small optical depth keep their digits.
    const Float root = sqrt(1 + q);
    const Float x = last * (p / (1 + p));
    const Float y = last * (q / root / (1 + root));
    const Int column = min(to_int(x), nodes - 2), row = min(to_int(y), nodes - 2);
    const Float share_x = x - to_float(column), share_y = y - to_float(row);
    const Int place = row * nodes + column;
    const Float near = mix(gather(table, place), gather(table + 1, place), share_x);
    const Float far = mix(gather(table + nodes, place), gather(table + nodes + 1, place), share_x);
    return mix(near, far, share_y);
}

LAMINA_SIMD_END

#endif
