// SPDX-License-Identifier: Apache-2.0
// Quadrature rules for pieces of rays of small optical depth.
#if defined(LAMINA_EXECUTORS_TILE_SHALLOW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_EXECUTORS_TILE_SHALLOW_INL_H_
#undef LAMINA_EXECUTORS_TILE_SHALLOW_INL_H_
#else
#define LAMINA_EXECUTORS_TILE_SHALLOW_INL_H_
#endif

#include "simd/vectors-inl.h"

LAMINA_SIMD_BEGIN

// Optical depth above which pieces are split: up to here the Gauss rules below are accurate to .01
// / 255.
inline constexpr float largest_piece_depth = 0.75f;

// Returns 1 - exp(-depth) for depths up to largest_piece_depth, with a relative error of 2e-5:
// interpolated at Chebyshev's nodes.
LAMINA_INLINE Float shallow_opacity(Float depth) {
    return depth * polynomial(depth, {0.99998385f, -0.49930894f, 0.16195904f, -0.031068699f});
}

// Gauss' rule on 0 .. 1.
template <std::size_t points>
struct GaussRule;
template <>
struct GaussRule<3> {
    static constexpr float nodes[] = {0.11270167f, 0.5f, 0.88729833f};
    static constexpr float weights[] = {0.27777778f, 0.44444444f, 0.27777778f};
};
template <>
struct GaussRule<4> {
    static constexpr float nodes[] = {0.069431844f, 0.33000948f, 0.66999052f, 0.93056816f};
    static constexpr float weights[] = {0.17392742f, 0.32607258f, 0.32607258f, 0.17392742f};
};

LAMINA_SIMD_END

#endif
