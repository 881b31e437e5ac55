// SPDX-License-Identifier: Apache-2.0
#include "optics/opacity.glsl"

// Returns the opacity between a piece's front and each of three positions x in the piece: 0 at its
// front, 1 at its back. p and q: as for front_weight().
vec3 opacity_before(vec3 x, float p, float q) {
    vec3 depth = x * (p * (1.0 - 0.5 * x) + q * (0.5 * x));
    return vec3(opacity_from_depth(depth.x), opacity_from_depth(depth.y), opacity_from_depth(depth.z));
}

// Returns the weight of the front's colour for a piece with extinction * length = p >= 0 at its
// front and q >= 0 at its back (docs/numerics.md, section 5): 1 - G, the mean over positions x in
// the piece of the opacity in front of x. The optical depth in front of x is u(x) = p x + k x^2, k
// = (q - p) / 2. Nine-point Gauss-Legendre quadrature integrates [0, seen], where u < 12; behind it
// opacity is taken as 1. All terms are >= 0. The error is below 2e-6 for all p and q up to 1e30,
// and below 1e-6 of the result if u stays below 1. The weight of the back's colour is the piece's
// opacity minus this weight.
float front_weight(float p, float q) {
    const float most_depth = 12.0;
    const vec3 near = vec3(0.015919880246187, 0.0819844463366821, 0.193314283649705);
    const vec3 middle = vec3(0.337873288298096, 0.5, 0.662126711701904);
    const vec3 near_weights = vec3(0.0406371941807872, 0.0903240803474287, 0.130305348201468);
    const vec3 middle_weights = vec3(0.156173538520001, 0.16511967750063, 0.156173538520001);

    float depth = 0.5 * p + 0.5 * q;
    float seen = 1.0;
    if (depth > most_depth) {  // solves u(seen) = most_depth, divided by depth
        float slope = p / depth, share = most_depth / depth;
        float root = sqrt(max(slope * slope + 2.0 * share * (q / depth - slope), 0.0));
        seen = min(2.0 * share / max(slope + root, 1e-18), 1.0);
    }
    return 1.0 - seen + seen * (dot(near_weights, opacity_before(seen * near, p, q)) +
                                dot(middle_weights, opacity_before(seen * middle, p, q)) +
                                dot(near_weights, opacity_before(seen * (1.0 - near), p, q)));
}
