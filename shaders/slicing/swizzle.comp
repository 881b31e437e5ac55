#version 450 core
// SPDX-License-Identifier: Apache-2.0
// Composites the opacity of a node, in codes, onto its parent's (executors/gl_code_tree.h).
#include "gl/pixels.glsl"
#include "compositing/over.glsl"
#include "slicing/swizzle.glsl"
#if ALPHA_ROUNDING == ROUND_STOCHASTIC
#include "compositing/random_bits.glsl"
uniform int seed;
uniform int stage;
#endif

layout(std430, binding = 0) buffer Parent { uint parent[]; };
layout(std430, binding = 1) readonly buffer Child { uint child[]; };
uniform int row_words;

void main() {
    ivec2 pixel = pixel_of_invocation();
    if (!is_drawn(pixel)) return;
    int place = pixel.y * row_words + pixel.x;
    vec2 scaled = swizzled(int(child[place]));
    uint random = 0u;
#if ALPHA_ROUNDING == ROUND_STOCHASTIC
    random = random_bits(uint(pixel.x), uint(pixel.y), uint(stage), uint(seed));
#endif
    uint alpha = round_alpha(ScaledValue(uint(scaled.x), double(scaled.y)), random);
    parent[place] = composited_opacity(alpha, parent[place]);
}
