#version 450 core
// SPDX-License-Identifier: Apache-2.0
// Draws one slab: the part of the fragment's ray inside the slab and inside the box. Opacity comes
// from extinction and true length, never from an assumed step. BITS: opacity is rounded to a code
// here, by dithering. OPACITY_ONLY: opacity alone, for a leaf of a tree of fixed-point nodes.
#include "slicing/segment.glsl"
#ifdef BITS
#include "slicing/slab_codes.glsl"
flat in uvec2 ranks;
uniform int image_rows;
#endif
layout(location = 0) out vec4 associated;
#ifdef OPACITY_ONLY
uniform DEPTH depth_scale;  // samples of the ray over samples of the leaf (docs/numerics.md, section 3)
#endif

flat in float slab;

void main() {
    Ray ray = view_ray(vec2(gl_FragCoord.x, 2.0 * image_middle.y - gl_FragCoord.y));
    REAL2 depths = clip_to_box(ray, slab_depths(slab, 1.0));
    if (!(depths.y > depths.x)) discard;
    Segment segment = integrate(ray, depths);
#ifdef OPACITY_ONLY
    segment.depth *= depth_scale;
#endif
    DEPTH opacity = opacity_from_depth(segment.depth);
#ifdef BITS
    ivec2 pixel = ivec2(gl_FragCoord.x, float(image_rows) - gl_FragCoord.y);
    CodedSlab coded = CodedSlab(pixel, uint(slab), ranks);
    uint alpha = alpha_code(coded, opacity);
#endif
#ifdef BITS
    vec3 color = segment.color;
#ifdef DITHER_COLOR
    color = vec3(color_codes(coded, color)) / float(LARGEST_CODE);
#endif
    float rounded = float(alpha) / float(LARGEST_CODE);
    associated = vec4(color * rounded, rounded);
#else
    associated = vec4(segment.color * opacity, opacity);
#endif
#ifdef OPACITY_ONLY
    associated.r = associated.a;
#endif
}
