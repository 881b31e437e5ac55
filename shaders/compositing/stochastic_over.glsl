// SPDX-License-Identifier: Apache-2.0
#include "compositing/codes.glsl"

// Twin of compositing/codes.h.
uint over_stochastic(double source, double alpha, uint below, uint random) {
    ScaledValue value = split_scaled(double(LARGEST_CODE) * source + double(below) * (1.0LF - alpha));
    uint code = value.whole + (double(random) < value.rest * 4294967296.0LF ? 1u : 0u);
    return min(code, LARGEST_CODE);
}
