#version 450 core
// SPDX-License-Identifier: Apache-2.0
// Draws an inner node of a compositing tree: composites its children in float (docs/numerics.md,
// section 4). They lie one behind the other in a buffer, the nearest first.
#include "gl/pixels.glsl"
#include "slicing/node_output.glsl"

layout(std430, binding = 1) readonly buffer Children { uint children[]; };
uniform int children_begin;  // place of pixel (0, 0) of the first child, in words
uniform int children_row;    // words in a row
uniform int child_words;     // words in a child
uniform int child_count;
uniform int node_samples;
uniform float sample_share;  // 1 / samples of the ray

// Returns the number of the node's samples in front of child i: floor(i n / k) for n samples and k
// children, without overflow (compositing/tree_shape.h).
int boundary(int i) {
    return i * (node_samples / child_count) + i * (node_samples % child_count) / child_count;
}

void main() {
    ivec2 pixel = pixel_of_invocation();
    if (!is_drawn(pixel)) return;
    vec3 color = vec3(0.0);
    float depth = 0.0;
    float transmittance = 1.0;
    for (int i = 0; i < child_count; ++i) {
        int samples = boundary(i + 1) - boundary(i);
        if (samples == 0) continue;
        int place = children_begin + i * child_words + pixel.y * children_row + NODE_WORDS * pixel.x;
        uint words[NODE_WORDS];
        for (int word = 0; word < NODE_WORDS; ++word) words[word] = children[place + word];
        vec4 child = unpacked_node(words);
        float child_depth = decode_depth(child.a, float(samples) * sample_share);
        depth += child_depth;
        float weight = transmittance * opacity_from_depth(child_depth);
        color += weight * largest_color * child.rgb;
        transmittance -= weight;
    }
    write_node(pixel, color, depth);
}
