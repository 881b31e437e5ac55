// SPDX-License-Identifier: Apache-2.0
#include "compositing/codes.glsl"

// Twin of compositing/codes.h. OVER_FUSED: it is rounded once instead of once a product.
uint divide_nearest(uint x) { return (x + (LARGEST_CODE - 1u) / 2u) / LARGEST_CODE; }

uint over(uint color, uint alpha, uint below) {
    uint source = color * alpha;
    uint kept = below * (LARGEST_CODE - alpha);
#ifdef OVER_FUSED
    return divide_nearest(source + kept);
#else
    return divide_nearest(source) + divide_nearest(kept);
#endif
}

uint under(uint color, uint alpha, uint above, uint above_alpha) {
#ifdef OVER_FUSED
    // The product has up to 48 bits and is exact in a double. So is the rounded quotient, because it is never nearer
    // to the middle between two codes than 1 / (2 M^2).
    double square = double(LARGEST_CODE) * double(LARGEST_CODE);
    double product = double(color * alpha) * double(LARGEST_CODE - above_alpha);
    return above + uint(floor(product / square + 0.5LF));
#else
    return above + divide_nearest(divide_nearest(color * alpha) * (LARGEST_CODE - above_alpha));
#endif
}
