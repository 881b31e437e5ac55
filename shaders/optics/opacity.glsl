// SPDX-License-Identifier: Apache-2.0
// Opacity of an optical depth >= 0: 1 - exp(-depth), twin of optics/opacity.h. GLSL has no expm1, and 1 - exp(-x) alone
// loses what straight compositing of many thin slabs needs (NUMERICS section 1): below 1/4 a series, whose first
// omitted term is 5e-8 of the result.
float opacity_from_depth(float depth) {
    if (depth >= 0.25) return 1.0 - exp(-depth);
    return depth * (1.0 - depth * (1.0 / 2.0 - depth * (1.0 / 6.0 - depth * (1.0 / 24.0 -
           depth * (1.0 / 120.0 - depth * (1.0 / 720.0))))));
}

// The same in double precision, for which GLSL has no exponential: the series at depth / 256, then eight times
// expm1(2x) = expm1(x) (2 + expm1(x)). Good to 1e-13.
double opacity_from_depth(double depth) {
    double x = -min(depth, 40.0LF) / 256.0LF;
    double sum = 1.0LF + x / 10.0LF;
    for (int i = 9; i >= 2; --i) sum = 1.0LF + x / double(i) * sum;
    double result = x * sum;
    for (int i = 0; i < 8; ++i) result *= 2.0LF + result;
    return -result;
}
