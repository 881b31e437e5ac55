// SPDX-License-Identifier: Apache-2.0
// Twin of compositing/codes.h. A code has BITS bits. ALPHA_ROUNDING says how opacities are rounded to codes.
#define LARGEST_CODE ((1u << BITS) - 1u)
#define ROUND_TRUNCATE 0
#define ROUND_NEAREST 1
#define ROUND_STOCHASTIC 2

const double code_noise = 1e-9LF;

struct ScaledValue {
    uint whole;
    double rest;
};

ScaledValue split_scaled(double scaled) {
    double whole = floor(scaled + code_noise);
    return ScaledValue(uint(whole), max(scaled - whole, 0.0LF));
}

uint code_nearest(double scaled) { return uint(floor(scaled + 0.5LF)); }

#ifdef ALPHA_ROUNDING
uint round_alpha(ScaledValue scaled, uint random) {
#if ALPHA_ROUNDING == ROUND_TRUNCATE
    return scaled.whole;
#elif ALPHA_ROUNDING == ROUND_NEAREST
    return scaled.whole + (scaled.rest + code_noise >= 0.5LF ? 1u : 0u);
#elif ALPHA_ROUNDING == ROUND_STOCHASTIC
    return scaled.whole + (double(random) < scaled.rest * 4294967296.0LF ? 1u : 0u);
#else
#error ALPHA_ROUNDING is none of these
#endif
}
#endif
