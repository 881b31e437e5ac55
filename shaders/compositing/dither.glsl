// SPDX-License-Identifier: Apache-2.0
#include "compositing/codes.glsl"

// Rounds a value times LARGEST_CODE to a code by dithering along depth (LaMar 2004, section 5): of
// DITHER_PERIOD consecutive slabs of one value, some get the next code above it and the others the
// code below, so that their mean is right. Each slab has a `rank`, a number 0 .. DITHER_PERIOD - 1
// that occurs once in a period, in shuffled order. With f the value's fraction between the two
// codes, the floor(DITHER_PERIOD * f) slabs with the lowest ranks round up. Codes are multiples of
// DITHER_INCREMENT, or LARGEST_CODE. Twin of dither_code in compositing/codes.h, bit for bit.
uint dither_code(double scaled, uint rank) {
    ScaledValue value = split_scaled(scaled / double(DITHER_INCREMENT));
    double terms = floor(double(DITHER_PERIOD) * value.rest + code_noise);  // number of ranks that round up
    uint steps = value.whole + (double(rank) < terms ? 1u : 0u);
    if (scaled >= double(LARGEST_CODE) - code_noise) return LARGEST_CODE;
    return min(steps * uint(DITHER_INCREMENT), LARGEST_CODE);
}
