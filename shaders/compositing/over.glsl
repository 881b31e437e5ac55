// SPDX-License-Identifier: Apache-2.0
#include "compositing/codes.glsl"

// OVER on codes: twin of compositing/codes.h, bit for bit. OVER_FUSED: the result is rounded once,
// and not each product.

// Returns x / LARGEST_CODE, rounded to the nearest whole number.
uint divide_nearest(uint x) { return (x + (LARGEST_CODE - 1u) / 2u) / LARGEST_CODE; }

// Returns `color` with opacity `alpha` over `below`.
uint over(uint color, uint alpha, uint below) {
    uint source = color * alpha;
    uint kept = below * (LARGEST_CODE - alpha);
#ifdef OVER_FUSED
    return divide_nearest(source + kept);
#else
    return divide_nearest(source) + divide_nearest(kept);
#endif
}

// Returns `above`, an associated colour of opacity `above_alpha`, with `color` of opacity `alpha`
// added behind it.
uint under(uint color, uint alpha, uint above, uint above_alpha) {
#ifdef OVER_FUSED
    // The product has up to 48 bits and is exact in a double. With M the largest code, the quotient
    // is never nearer than 1 / (2 M^2) to the middle between two codes, so the double rounds to the
    // right code.
    double square = double(LARGEST_CODE) * double(LARGEST_CODE);
    double product = double(color * alpha) * double(LARGEST_CODE - above_alpha);
    return above + uint(floor(product / square + 0.5LF));
#else
    return above + divide_nearest(divide_nearest(color * alpha) * (LARGEST_CODE - above_alpha));
#endif
}

// Returns the pixel `there` with a fragment composited behind it (FRONT_TO_BACK) or over it.
// `color`: not associated.
uvec4 composited(uvec3 color, uint alpha, uvec4 there) {
    uvec4 source = uvec4(color, LARGEST_CODE);
    uvec4 result;
    for (int channel = 0; channel < 4; ++channel) {
#ifdef FRONT_TO_BACK
        result[channel] = under(source[channel], alpha, there[channel], there.a);
#else
        result[channel] = over(source[channel], alpha, there[channel]);
#endif
    }
    return result;
}

// Returns the opacity `there` of a pixel with that of a fragment composited in the same way.
uint composited_opacity(uint alpha, uint there) {
#ifdef FRONT_TO_BACK
    return under(LARGEST_CODE, alpha, there, there);
#else
    return over(LARGEST_CODE, alpha, there);
#endif
}
