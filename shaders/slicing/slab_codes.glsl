// SPDX-License-Identifier: Apache-2.0
// Rounds the colour and the opacity of a slab to codes: by dithering, or as render.emulate says.
#include "compositing/codes.glsl"
#ifdef DITHER_PERIOD
#include "compositing/dither.glsl"
#endif
#if defined(ALPHA_ROUNDING) && ALPHA_ROUNDING == ROUND_STOCHASTIC
#include "compositing/random_bits.glsl"
uniform int seed;
#endif

// A slab of a pixel's ray.
struct CodedSlab {
    ivec2 pixel;  // row 0 is at the top
    uint number;
    uvec2 ranks;  // of dithering, for alpha and for colour
};

uint alpha_code(CodedSlab slab, double opacity) {
    double scaled = double(LARGEST_CODE) * opacity;
#ifdef DITHER_PERIOD
    return dither_code(scaled, slab.ranks.x);
#else
    uint random = 0u;
#if ALPHA_ROUNDING == ROUND_STOCHASTIC
    random = random_bits(uint(slab.pixel.x), uint(slab.pixel.y), slab.number, uint(seed));
#endif
    return round_alpha(split_scaled(scaled), random);
#endif
}

uint color_code(CodedSlab slab, float color) {
    double scaled = double(LARGEST_CODE) * double(clamp(color, 0.0, 1.0));
#ifdef DITHER_COLOR
    return dither_code(scaled, slab.ranks.y);
#else
    return code_nearest(scaled);
#endif
}

uvec3 color_codes(CodedSlab slab, vec3 color) {
    return uvec3(color_code(slab, color.r), color_code(slab, color.g), color_code(slab, color.b));
}
