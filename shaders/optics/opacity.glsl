// SPDX-License-Identifier: Apache-2.0
// Returns the opacity 1 - exp(-depth) of an optical depth >= 0, with a relative error of 3e-7 at
// every depth, infinity included. This is the twin of opacity_from_depth() (optics/opacity.h). GLSL
// has no expm1, and 1 - exp(-x) loses digits that compositing many thin slabs needs
// (docs/numerics.md, section 1). Method: exp(-depth) = 2^-n 2^f with |f| <= 1/2. 1 - 2^-n is exact;
// (2^f - 1) / f is a minimax polynomial of relative error 1.1e-8. There is no branch, because
// llvmpipe would execute both sides.
float opacity_from_depth(float depth) {
    float octaves = min(depth * 1.4426950408889634, 126.0);
    int n = int(octaves + 0.5);
    float f = float(n) - octaves;
    float power = intBitsToFloat(0x3f800000 - (n << 23));  // 2^-n
    float slope = 0.693147187926693 + f * (0.24022649794962264 + f * (0.0555035743364266 +
                  f * (0.009618237494907015 + f * (0.0013390735477607873 + f * 0.00015403512367553545))));
    return (1.0 - power) - power * (f * slope);
}

// Returns the opacity in double precision, for which GLSL has no exp(): the series of expm1 at
// depth / 256, then eight times expm1(2x) = expm1(x) (2 + expm1(x)). Its error is below 1e-13.
double opacity_from_depth(double depth) {
    double x = -min(depth, 40.0LF) / 256.0LF;
    double sum = 1.0LF + x / 10.0LF;
    for (int i = 9; i >= 2; --i) sum = 1.0LF + x / double(i) * sum;
    double result = x * sum;
    for (int i = 0; i < 8; ++i) result *= 2.0LF + result;
    return -result;
}
