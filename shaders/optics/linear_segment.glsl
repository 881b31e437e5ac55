// SPDX-License-Identifier: Apache-2.0
#include "optics/opacity.glsl"

// Integrates a segment on which colour and extinction are linear. Opacity has a closed form. Colour
// needs front_weight(): the weight of the front's colour (optics/segment_integral.h) for extinction
// * length p at the front and q at the back. It is a polynomial if THIN is defined, else a lookup
// in a table. TABLE_COLORED: colours come from the transfer function, else from `single_color`.
#ifdef TABLE_COLORED
#ifdef THIN
float front_weight(float p, float q) {
    float c0 = q * (0.166777794 + q * (-0.025093103 + q * (0.002890381 - q * 0.000196459)));
    float c1 = 0.333037217 + q * (-0.074477034 + q * (0.011162302 - q * 0.000919007));
    float c2 = -0.065656503 + q * (0.015676728 - q * 0.001696676);
    float c3 = 0.008428908 - q * 0.001502640;
    float c4 = -0.000561545;
    return c0 + p * (c1 + p * (c2 + p * (c3 + p * c4)));
}
#else
uniform sampler2D front_weights;

float front_weight(float p, float q) {
    p = min(p, 1e30);
    q = min(q, 1e30);
    // Nodes lie at equal steps of 1 - 1 / (1 + p) and 1 - 1 / sqrt(1 + q), which are rewritten as p
    // / (1 + p) and (q / root) / (1 + root): no subtraction, so small p and q keep their digits.
    float root = sqrt(1.0 + q);
    vec2 nodes = float(FRONT_WEIGHT_NODES - 1) * vec2(p, q / root) / (1.0 + vec2(p, root));
#ifdef TABLE_FILTERED
    return texture(front_weights, (nodes + 0.5) / float(FRONT_WEIGHT_NODES)).r;
#else
    ivec2 corner = min(ivec2(nodes), ivec2(FRONT_WEIGHT_NODES - 2));
    vec2 share = nodes - vec2(corner);
    vec2 near = vec2(texelFetch(front_weights, corner, 0).r, texelFetch(front_weights, corner + ivec2(0, 1), 0).r);
    vec2 far = vec2(texelFetch(front_weights, corner + ivec2(1, 0), 0).r,
                    texelFetch(front_weights, corner + ivec2(1, 1), 0).r);
    vec2 mixed = near + share.x * (far - near);
    return mixed.x + share.y * (mixed.y - mixed.x);
#endif
}
#endif

// Returns the segment's associated colour and opacity. `front`, `back`: colour (rgb) and extinction
// (a) at its ends.
vec4 integrate_linear(vec4 front, vec4 back, float world_length) {
    float p = front.a * world_length, q = back.a * world_length;
    float opacity = opacity_from_depth(0.5 * p + 0.5 * q);
    float weight = min(front_weight(p, q), opacity);
    return vec4(opacity * back.rgb + weight * (front.rgb - back.rgb), opacity);
}
#else
uniform vec3 single_color;

vec4 integrate_linear(float front_extinction, float back_extinction, float world_length) {
    float opacity = opacity_from_depth((0.5 * front_extinction + 0.5 * back_extinction) * world_length);
    return vec4(single_color * opacity, opacity);
}
#endif
