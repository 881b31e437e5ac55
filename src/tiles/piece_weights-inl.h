// SPDX-License-Identifier: Apache-2.0
// Vector form of shaders/optics/piece_weights.glsl, which gives the reasons.
#if defined(LAMINA_TILES_PIECE_WEIGHTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_PIECE_WEIGHTS_INL_H_
#undef LAMINA_TILES_PIECE_WEIGHTS_INL_H_
#else
#define LAMINA_TILES_PIECE_WEIGHTS_INL_H_
#endif

#include <cstddef>

#include "tiles/opacity-inl.h"

LAMINA_SIMD_BEGIN

// Returns the weight of the front's colour on a linear piece with extinction * length = p at its
// front and q at its back, by nine-point Gauss-Legendre quadrature over optical depths below 12.
LAMINA_INLINE Float piece_front_weight(Float p, Float q) {
    constexpr float nodes[] = {
        0.015919880246187f, 0.0819844463366821f, 0.193314283649705f,  0.337873288298096f, 0.5f,
        0.662126711701904f, 0.806685716350295f,  0.9180155536633179f, 0.984080119753813f};
    constexpr float weights[] = {0.0406371941807872f, 0.0903240803474287f, 0.130305348201468f,
                                 0.156173538520001f,  0.16511967750063f,   0.156173538520001f,
                                 0.130305348201468f,  0.0903240803474287f, 0.0406371941807872f};
    constexpr float most_depth = 12;
    const Float depth = 0.5f * p + 0.5f * q;
    // Place up to which the optical depth is most_depth, in units of depth.
    const Float slope = p / depth, share = most_depth / depth;
    const Float twice = share + share;
    const Float square = slope * slope + twice * (q / depth - slope);
    const Float root = sqrt(max(square, 0));
    const Float place = twice / max(slope + root, 1e-18f);
    const Float seen = select(depth > most_depth, min(place, 1), 1);
    Float sum(0);
    for (std::size_t i = 0; i < std::size(nodes); ++i) {
        const Float x = seen * nodes[i], half_x = 0.5f * x;
        const Float before = p * (1 - half_x) + q * half_x;
        sum += weights[i] * opacity_from_depth(x * before);
    }
    return 1 - seen + seen * sum;
}

LAMINA_SIMD_END

#endif
