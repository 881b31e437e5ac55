#version 450 core
// SPDX-License-Identifier: Apache-2.0
// Composites slabs on codes: rounds the colour and the opacity of each to codes, as render.emulate
// says, and computes OVER on codes in registers. The picture keeps the codes between two dispatches.
// OPACITY_ONLY: opacity alone, for a leaf of a tree.
#include "gl/pixels.glsl"
#include "slicing/segment.glsl"
#include "slicing/slab_codes.glsl"
#include "compositing/over.glsl"
#include "compositing/packed_codes.glsl"
#ifdef DITHER_PERIOD
#include "slicing/dither_ranks.glsl"
#endif

layout(std430, binding = 0) buffer Picture { uint words_of_picture[]; };
uniform int output_begin;  // place of pixel (0, 0), in words
uniform int output_row;    // words in a row
uniform float first_slab;  // slabs that this dispatch draws
uniform float slab_count;
#ifdef OPACITY_ONLY
uniform DEPTH depth_scale;  // samples of the ray over samples of the leaf (docs/numerics.md, section 3)
#endif

uvec2 ranks_if_dithered(int slab) {
#ifdef DITHER_PERIOD
    return ranks_of(slab);
#else
    return uvec2(0u);
#endif
}

void draw(ivec2 pixel) {
    Ray ray = view_ray(vec2(pixel) + 0.5);
    REAL2 whole = clip_to_box(ray, slab_depths(first_slab, slab_count));
    if (!(whole.y > whole.x)) return;
    int place = output_begin + pixel.y * output_row + CODE_WORDS * pixel.x;
    uint words[CODE_WORDS];
    for (int word = 0; word < CODE_WORDS; ++word) words[word] = words_of_picture[place + word];
    uvec4 codes = unpacked_codes(words);
    vec2 range = slabs_of(whole, first_slab, slab_count);
    for (float i = range.x; i < range.y; ++i) {
#ifdef FRONT_TO_BACK
        float slab = i;
#else
        float slab = range.x + range.y - 1.0 - i;
#endif
        REAL2 depths = slab_depths(slab, 1.0);
        depths = REAL2(max(depths.x, whole.x), min(depths.y, whole.y));
        if (!(depths.y > depths.x)) continue;
        Segment segment = integrate(ray, depths);
        CodedSlab coded = CodedSlab(pixel, uint(slab), ranks_if_dithered(int(slab)));
#ifdef OPACITY_ONLY
        uint alpha = alpha_code(coded, opacity_from_depth(segment.depth * depth_scale));
        codes.r = composited_opacity(alpha, codes.r);
#else
        uint alpha = alpha_code(coded, opacity_from_depth(segment.depth));
        codes = composited(color_codes(coded, segment.color), alpha, codes);
#endif
    }
    words = packed_codes(codes);
    for (int word = 0; word < CODE_WORDS; ++word) words_of_picture[place + word] = words[word];
}

#include "gl/march.glsl"
