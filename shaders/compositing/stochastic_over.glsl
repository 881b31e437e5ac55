// SPDX-License-Identifier: Apache-2.0
#include "compositing/codes.glsl"

// Returns `source`, associated and in [0, 1], with opacity `alpha` over the code `below`, in real
// arithmetic; the result is rounded up with the probability of its fraction. Twin of
// over_stochastic in compositing/codes.h, bit for bit.
uint over_stochastic(double source, double alpha, uint below, uint random) {
    ScaledValue value = split_scaled(double(LARGEST_CODE) * source + double(below) * (1.0LF - alpha));
    uint code = value.whole + (double(random) < value.rest * 4294967296.0LF ? 1u : 0u);
    return min(code, LARGEST_CODE);
}
