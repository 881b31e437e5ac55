// SPDX-License-Identifier: Apache-2.0
// Opacity of an optical depth >= 0: 1 - exp(-depth), twin of optics/opacity.h. GLSL has no expm1, and 1 - exp(-x) alone
// loses what straight compositing of many thin slabs needs (NUMERICS section 1): below 1/4 a series, whose first
// omitted term is 5e-8 of the result.
float opacity_from_depth(float depth) {
    if (depth >= 0.25) return 1.0 - exp(-depth);
    return depth * (1.0 - depth * (1.0 / 2.0 - depth * (1.0 / 6.0 - depth * (1.0 / 24.0 -
           depth * (1.0 / 120.0 - depth * (1.0 / 720.0))))));
}
