// SPDX-License-Identifier: Apache-2.0
#include "optics/opacity.glsl"

// Integrates segments with a table of equidistant nodes: twin of UniformTable::lookup
// (preintegration/preintegration_table.h). The table has TABLE_NODES x TABLE_NODES x TABLE_LAYERS texels (front node,
// back node, layer of length). The last component of a texel is mean extinction or opacity, as TABLE_STORE says. With
// TABLE_COLORED, rgb is emission or associated colour, respectively. TABLE_FILTERED: the texture unit interpolates,
// whose weights have 8 bits on GPUs. Otherwise four or eight texels are interpolated in float32.

// Values of TABLE_MAPPING, as in LengthMapping.
#define MAPPING_OCTAVE 0
#define MAPPING_LOG2 1
#define MAPPING_LINEAR 2
// Values of TABLE_STORE, as in TableStore.
#define STORE_MEAN_EXTINCTION 0
#define STORE_OPACITY 1

#if TABLE_LAYERS > 1
uniform sampler3D uniform_table;
uniform float inverse_first_length;  // 1 / length of layer 1, per world unit
#else
uniform sampler2D uniform_table;
#endif
uniform float table_scale;  // value = texel * table_scale
#ifndef TABLE_COLORED
uniform vec3 single_color;
#endif

#if TABLE_LAYERS > 1
// Returns the coordinate of a length in the table; layers have whole numbers. It may exceed that of the last layer.
float length_layer(float world_length) {
    float v = world_length * inverse_first_length;
#if TABLE_LAYERS == 2 || TABLE_MAPPING == MAPPING_LINEAR
    return v;
#elif TABLE_MAPPING == MAPPING_LOG2
    return log2(max(v, 1.0)) + min(v, 1.0);  // Kraus 2004, Equation 1
#elif TABLE_MAPPING == MAPPING_OCTAVE
    // The bits of a float are linear within each octave: 1 + o + (v / 2^o - 1) (docs/numerics.md, section 5) is the
    // number of octaves from 1/2 on. For v < 1 this is less than v, which is the coordinate there.
    const int bits_of_half = 0x3f000000;
    float octaves = float(floatBitsToInt(v) - bits_of_half) * (1.0 / 8388608.0);
    return max(octaves, min(v, 1.0));
#else
#error TABLE_MAPPING is none of these
#endif
}
#endif

#ifdef TABLE_FILTERED

vec4 table_entry(float front, float back, float world_length) {
    const float nodes = float(TABLE_NODES);
    vec2 place = vec2(front, back) * ((nodes - 1.0) / nodes) + 0.5 / nodes;
#if TABLE_LAYERS > 1
    return texture(uniform_table, vec3(place, (length_layer(world_length) + 0.5) * (1.0 / float(TABLE_LAYERS))));
#else
    return texture(uniform_table, place);
#endif
}

#else

#if TABLE_LAYERS > 1
vec4 table_texel(ivec2 node, int layer) { return texelFetch(uniform_table, ivec3(node, layer), 0); }
#else
vec4 table_texel(ivec2 node, int layer) { return texelFetch(uniform_table, node, 0); }
#endif

vec4 table_layer(ivec2 corner, vec2 share, int layer) {
    vec4 front = table_texel(corner, layer);
    vec4 back = table_texel(corner + ivec2(0, 1), layer);
    front += share.x * (table_texel(corner + ivec2(1, 0), layer) - front);
    back += share.x * (table_texel(corner + ivec2(1, 1), layer) - back);
    return front + share.y * (back - front);
}

vec4 table_entry(float front, float back, float world_length) {
    vec2 nodes = clamp(vec2(front, back), 0.0, 1.0) * float(TABLE_NODES - 1);
    ivec2 corner = min(ivec2(nodes), ivec2(TABLE_NODES - 2));
    vec2 share = nodes - vec2(corner);
#if TABLE_LAYERS > 1
    float layer = min(length_layer(world_length), float(TABLE_LAYERS - 1));
    int below = min(int(layer), TABLE_LAYERS - 2);
    vec4 entry = table_layer(corner, share, below);
    return entry + (layer - float(below)) * (table_layer(corner, share, below + 1) - entry);
#else
    return table_layer(corner, share, 0);
#endif
}

#endif

// Returns the associated colour and opacity of a segment on which the scalar is linear from `front` to `back`,
// normalised so that the table covers [0, 1].
vec4 integrate_segment(float front, float back, float world_length) {
    vec4 entry = table_entry(front, back, world_length);
#if TABLE_STORE == STORE_OPACITY
#ifdef TABLE_COLORED
    return entry * table_scale;
#else
    return vec4(single_color, 1.0) * (entry.r * table_scale);
#endif
#elif TABLE_STORE == STORE_MEAN_EXTINCTION
#ifdef TABLE_COLORED
    float alpha = opacity_from_depth(entry.a * (table_scale * world_length));
    // If the optical depth is 0, so is the emission. The scale cancels.
    return vec4(entry.rgb * (alpha / max(entry.a, 1e-37)), alpha);
#else
    return vec4(single_color, 1.0) * opacity_from_depth(entry.r * (table_scale * world_length));
#endif
#else
#error TABLE_STORE is none of these
#endif
}
