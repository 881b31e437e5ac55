// SPDX-License-Identifier: Apache-2.0
#include "optics/opacity.glsl"

// Converts the optical depth of a node of a compositing tree to a number in [0, 1] that its image
// stores, and back (docs/numerics.md, section 4). Twin of encode_depth() and decode_depth() of
// compositing/codes.h for the code NODE_CODE. `share`: the node's share of its ray's samples.
#define CODE_MINIMAX 0
#define CODE_PHI 1
#define CODE_ALPHA 2

// Optical depth that a code of 1 represents.
const float opaque_node_depth = 1e4;
const float inverse_e = 0.36787944117144233;
const float euler = 2.718281828459045;

// Returns -log(1 - value). GLSL's log is inaccurate just below 1 (docs/numerics.md, section 1), so
// for values below 1/4 this is 2 artanh(value / (2 - value)) as a series, whose first omitted term
// is 2e-8 of the result.
float depth_from_opacity(float value) {
    if (value >= 0.25) return -log(1.0 - value);
    float z = value / (2.0 - value);
    float zz = z * z;
    return 2.0 * z * (1.0 + zz * (1.0 / 3.0 + zz * (1.0 / 5.0 + zz * (1.0 / 7.0))));
}

float encode_depth(float depth, float share) {
#if NODE_CODE == CODE_PHI
    return opacity_from_depth(depth / share);
#elif NODE_CODE == CODE_ALPHA
    return opacity_from_depth(depth);
#elif NODE_CODE == CODE_MINIMAX
    float sigma = depth / share;
    float log_part = -inverse_e * log(share);
    float scaled = opacity_from_depth(sigma);
    if (sigma > 1.0) scaled = 1.0 - inverse_e + inverse_e * log(sigma);
    if (sigma > 1.0 && depth > 1.0) scaled = 1.0 + log_part - exp(-depth);
    return min(scaled / (1.0 + log_part), 1.0);
#else
#error NODE_CODE is none of these
#endif
}

float decode_depth(float value, float share) {
    if (value >= 1.0) return opaque_node_depth;
#if NODE_CODE == CODE_PHI
    return min(share * depth_from_opacity(value), opaque_node_depth);
#elif NODE_CODE == CODE_ALPHA
    return min(depth_from_opacity(value), opaque_node_depth);
#elif NODE_CODE == CODE_MINIMAX
    float log_part = -inverse_e * log(share);
    float u = value * (1.0 + log_part);
    if (u <= 1.0 - inverse_e) return share * depth_from_opacity(u);
    if (u <= 1.0 - inverse_e + log_part) return share * exp(euler * (u - 1.0) + 1.0);
    float rest = 1.0 + log_part - u;  // exp(-depth)
    return rest > 0.0 ? min(-log(rest), opaque_node_depth) : opaque_node_depth;
#else
#error NODE_CODE is none of these
#endif
}
