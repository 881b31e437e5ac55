// SPDX-License-Identifier: Apache-2.0
// Codes of BITS bits: whole numbers 0 .. LARGEST_CODE, which represent code / LARGEST_CODE. Twin of
// compositing/codes.h, bit for bit. A scaled value is a value in [0, 1] times LARGEST_CODE.
// ALPHA_ROUNDING says how opacities are rounded to codes.
#define LARGEST_CODE ((1u << BITS) - 1u)
#define ROUND_TRUNCATE 0
#define ROUND_NEAREST 1
#define ROUND_STOCHASTIC 2

// Distance below a whole number at which a scaled value counts as that number, against roundings of
// double.
const double code_noise = 1e-9LF;

// A scaled value, split into its whole part and the rest, 0 <= rest < 1.
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
// Rounds an opacity to a code. `random`: 32 random bits, used for stochastic rounding only.
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
