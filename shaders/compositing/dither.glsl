// SPDX-License-Identifier: Apache-2.0
#include "compositing/codes.glsl"

// Twin of dither_code in compositing/codes.h. DITHER_PERIOD and DITHER_INCREMENT describe the pattern.
uint dither_code(double scaled, uint rank) {
    ScaledValue value = split_scaled(scaled / double(DITHER_INCREMENT));
    double terms = floor(double(DITHER_PERIOD) * value.rest + code_noise);
    uint steps = value.whole + (double(rank) < terms ? 1u : 0u);
    if (scaled >= double(LARGEST_CODE) - code_noise) return LARGEST_CODE;
    return min(steps * uint(DITHER_INCREMENT), LARGEST_CODE);
}
