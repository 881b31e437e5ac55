// SPDX-License-Identifier: Apache-2.0
// Writes the result of a node of a compositing tree whose nodes are computed in float
// (docs/numerics.md, section 4). ROOT: writes associated colour and opacity, the picture. Other
// nodes write colour that is not associated, and the code of the optical depth.
#include "compositing/node_code.glsl"
#include "slicing/node_packing.glsl"

layout(std430, binding = 0) writeonly buffer Output { uint words_of_node[]; };
uniform int output_begin;  // place of pixel (0, 0), in words
uniform int output_row;    // words in a row

uniform float node_share;     // the node's share of the ray's samples
uniform float largest_color;  // the colour that nodes store as 1, because fixed point holds no more
#if defined(MONOCHROME) && !defined(SINGLE_COLOR)
uniform vec3 single_color;
#endif

// `color`: associated. `depth`: optical depth.
void write_node(ivec2 pixel, vec3 color, float depth) {
    float opacity = opacity_from_depth(depth);
#ifdef MONOCHROME
    color = single_color * opacity;
#endif
#ifdef ROOT
    const int count = PIXEL_WORDS;
    uint words[PIXEL_WORDS] = packed_pixel(vec4(color, opacity));
#else
    const int count = NODE_WORDS;
    uint words[NODE_WORDS] = packed_node(opacity > 0.0 ? color / (opacity * largest_color) : vec3(0.0),
                                         encode_depth(depth, node_share));
#endif
    int place = output_begin + pixel.y * output_row + count * pixel.x;
    for (int word = 0; word < count; ++word) words_of_node[place + word] = words[word];
}
