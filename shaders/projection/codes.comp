#version 450 core
// SPDX-License-Identifier: Apache-2.0
// Composites cell fragments on codes, back to front, in registers. A workgroup draws a tile of 8 x 8 pixels, for which
// the cell fragments are listed that may cover some of them (projection/gl_tet_codes.h). EMULATED: each fragment is
// rounded to codes, and OVER is computed on codes, as render.emulate says. Otherwise OVER is computed in real
// arithmetic, and its result is rounded at random (ProjectDither::after_blend). OPACITY_ONLY: draws opacity alone, for
// the leaves of a compositing tree. The picture keeps the codes between two dispatches.
#include "gl/tile.glsl"
#include "projection/sources.glsl"
vec2 window_place;
#define SEEN
#define READS_TEXELS
#define WINDOW_PLACE window_place
#include "projection/silhouette.glsl"
#include "projection/tet_color.glsl"
#include "compositing/over.glsl"
#include "compositing/packed_codes.glsl"
#include "compositing/random_bits.glsl"
#ifndef EMULATED
#include "compositing/stochastic_over.glsl"
#endif

layout(std430, binding = 0) buffer Picture { uint words_of_picture[]; };
layout(std430, binding = 1) readonly buffer Tiles { uvec4 tiles[]; };  // first column, first row, range of `listed`
// The words of CodeEntry (projection/gl_tet_codes.h): the pixels of the tile's upper and lower half that the cell
// fragment may cover, and the number of its record.
uniform usamplerBuffer listed;

uniform ivec2 picture_size;
uniform int picture_row;        // words in a row
uniform int first_tile;         // of the dispatch
uniform int first_of_list;      // entry of each tile's list with which the dispatch begins
uniform int most_of_list;       // entries that it draws at most
uniform int seed;

#ifdef EMULATED
uvec4 composited_fragment(vec4 color, ivec2 pixel, uvec4 there) {
    uint random = 0u;
#if ALPHA_ROUNDING == ROUND_STOCHASTIC
    random = random_bits(uint(pixel.x), uint(pixel.y), cell_fragment_number(), uint(seed));
#endif
    uint alpha = round_alpha(split_scaled(double(LARGEST_CODE) * double(color.a)), random);
#ifdef OPACITY_ONLY
    return uvec4(composited_opacity(alpha, there.r), 0u, 0u, 0u);
#else
    const float above_half_codes = 1.0 + 1.0 / 2097152.0;  // compositing/codes.h
    vec3 separate = color.a > 0.0 ? clamp(color.rgb / color.a * above_half_codes, 0.0, 1.0) : vec3(0.0);
    uvec3 codes;
    for (int channel = 0; channel < 3; ++channel)
        codes[channel] = code_nearest(double(LARGEST_CODE) * double(separate[channel]));
    return composited(codes, alpha, there);
#endif
}
#else
uvec4 composited_fragment(vec4 color, ivec2 pixel, uvec4 there) {
    uint random = random_bits(uint(pixel.x), uint(pixel.y), cell_fragment_number(), uint(seed));
#ifdef OPACITY_ONLY
    return uvec4(over_stochastic(double(color.a), double(color.a), there.r, random), 0u, 0u, 0u);
#else
    uvec4 result;
    for (int channel = 0; channel < 4; ++channel)
        result[channel] = over_stochastic(double(clamp(color[channel], 0.0, 1.0)), double(color.a), there[channel], random);
    return result;
#endif
}
#endif

void main() {
    uvec4 tile = tiles[uint(first_tile) + gl_WorkGroupID.x];
    ivec2 in_tile = pixel_in_tile();
    ivec2 pixel = ivec2(tile.xy) + in_tile;
    uint next = tile.z + uint(first_of_list), end = min(tile.w, next + uint(most_of_list));
    if (any(greaterThanEqual(pixel, picture_size))) return;
    window_place = vec2(pixel.x + 0.5, picture_size.y - pixel.y - 0.5);
    int place = pixel.y * picture_row + CODE_WORDS * pixel.x;
    uint words[CODE_WORDS];
    for (int word = 0; word < CODE_WORDS; ++word) words[word] = words_of_picture[place + word];
    uvec4 codes = unpacked_codes(words);
    int half_of_tile = in_tile.y >> 2;
    uint bit = 1u << (8 * (in_tile.y & 3) + in_tile.x);
    while (true) {
        // Software rasterisers skip no branches, so each pixel looks for its own next fragment.
        while (next < end && (texelFetch(listed, int(3u * next) + half_of_tile).x & bit) == 0u) ++next;
        if (next >= end) break;
        read_record(texelFetch(listed, int(3u * next) + 2).x);
        ++next;
        codes = composited_fragment(tet_color(), pixel, codes);
    }
    words = packed_codes(codes);
    for (int word = 0; word < CODE_WORDS; ++word) words_of_picture[place + word] = words[word];
}
