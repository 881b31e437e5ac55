#version 450 core
// SPDX-License-Identifier: Apache-2.0
// Draws an inner node of a compositing tree: composites its children in float (docs/numerics.md,
// section 4). They are layers of an array texture, the nearest first.
#include "slicing/node_output.glsl"

uniform sampler2DArray children;
#ifdef ALPHA_APART
uniform sampler2DArray children_alpha;
#endif
uniform int child_count;
uniform int node_samples;
uniform float sample_share;  // 1 / samples of the ray
uniform int first_row;       // of the band of the image that is being drawn

// Returns the number of the node's samples in front of child i: floor(i n / k) for n samples and k
// children, without overflow (compositing/tree_shape.h).
int boundary(int i) {
    return i * (node_samples / child_count) + i * (node_samples % child_count) / child_count;
}

void main() {
    ivec2 place = ivec2(gl_FragCoord.xy) - ivec2(0, first_row);
    vec3 color = vec3(0.0);
    float depth = 0.0;
    float transmittance = 1.0;
    for (int i = 0; i < child_count; ++i) {
        int samples = boundary(i + 1) - boundary(i);
        if (samples == 0) continue;
        vec4 child = texelFetch(children, ivec3(place, i), 0);
#ifdef MONOCHROME
        float code = child.r;
#elif defined(ALPHA_APART)
        float code = texelFetch(children_alpha, ivec3(place, i), 0).r;
#else
        float code = child.a;
#endif
        float child_depth = decode_depth(code, float(samples) * sample_share);
        depth += child_depth;
        float weight = transmittance * opacity_from_depth(child_depth);
        color += weight * largest_color * child.rgb;
        transmittance -= weight;
    }
    write_node(color, depth);
}
