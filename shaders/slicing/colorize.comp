#version 450 core
// SPDX-License-Identifier: Apache-2.0
// Makes the picture, in codes, from the opacity in the root of a tree and a single colour.
#include "gl/pixels.glsl"
#include "compositing/over.glsl"
#include "compositing/packed_codes.glsl"

layout(std430, binding = 0) writeonly buffer Picture { uint words_of_picture[]; };
layout(std430, binding = 1) readonly buffer Root { uint root[]; };
uniform int picture_row;  // words in a row
uniform int row_words;    // of the root
uniform vec3 single_color;

void main() {
    ivec2 pixel = pixel_of_invocation();
    if (!is_drawn(pixel)) return;
    uint alpha = root[pixel.y * row_words + pixel.x];
    uvec4 codes = uvec4(alpha);
    for (int channel = 0; channel < 3; ++channel) {
        uint color = code_nearest(double(LARGEST_CODE) * double(clamp(single_color[channel], 0.0, 1.0)));
        codes[channel] = divide_nearest(color * alpha);
    }
    uint words[CODE_WORDS] = packed_codes(codes);
    int place = pixel.y * picture_row + CODE_WORDS * pixel.x;
    for (int word = 0; word < CODE_WORDS; ++word) words_of_picture[place + word] = words[word];
}
